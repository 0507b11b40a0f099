// Greedy episodes on held-out traffic -> summaries and action logs in the run directory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "actor/episode.h"
#include "actor/planners.h"
#include "actor/world/world.h"
#include "proto/run/run_directory.h"
#include "proto/settings/settings.h"

namespace corridor::actor {

struct EvaluationTask {
  PlannerPair pair;
  std::uint64_t seed = 0;               // of the traffic; says nothing about training
  std::int64_t steps = 0;               // the last episode is cut off there
  std::filesystem::path fcd_directory;  // empty: SUMO writes no trajectories
};

// Drives episodes 0, 1, 2 ... of the task's seed and writes
//   evaluation/<planner>_<seed>.json                        totals, and one object an episode
//   evaluation/episodes/<planner>_<seed>_<episode>.json     what drives it again
// `progress` hears of the steps done after each episode; when it returns false the evaluation ends
// without writing its totals. Equal tasks write equal files.
void evaluate(const RunConfig& config, const Networks& networks, const EvaluationTask& task,
              const RunDirectory& directory, world::World& world,
              const std::function<bool(std::int64_t steps)>& progress);

// Drives a recorded episode again.
struct Redriven {
  std::uint64_t recorded_hash = 0;
  std::uint64_t hash = 0;
  EpisodeSummary summary;
};
// Throws Failure when the file is no episode, or is of other settings.
Redriven redrive(const RunConfig& config, const std::filesystem::path& file, world::World& world,
                 const std::filesystem::path& fcd_output);

}  // namespace corridor::actor
