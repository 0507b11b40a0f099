// Which processes a command starts: the run's configuration -> a list. Pure.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "proto/run/actor_task.h"
#include "proto/run/run_directory.h"
#include "proto/settings/settings.h"

namespace corridor::cluster {

struct ProcessPlan {
  std::string name;               // unique in a list; people see it
  std::vector<std::string> argv;  // argv[0] is the program's path
  std::filesystem::path log;      // standard output and error are appended to it
  bool replaceable = false;       // can be started again while the others go on
  bool ends_by_itself = false;    // before the main process has, when its own work is done
  bool operator==(const ProcessPlan&) const = default;
};

// Replay server, learner, and actors 0 .. actors-1. The learner ends by itself when all is done,
// and is to be stopped before the others, since its checkpoint needs them. `programs` is the
// directory of the programs.
std::vector<ProcessPlan> training_plan(const RunSettings& settings, const RunDirectory& directory,
                                       const std::filesystem::path& programs);

// One greedy evaluation by one actor process.
struct EvaluationJob {
  std::string planner;
  std::uint64_t seed = 0;
  std::int64_t steps = 0;

  EvaluationName name() const { return {planner, seed}; }
  bool operator==(const EvaluationJob&) const = default;
};

// Every planner with every seed, planner by planner.
std::vector<EvaluationJob> evaluation_jobs(const std::vector<std::string>& planners,
                                           const std::vector<std::uint64_t>& seeds,
                                           std::int64_t steps);
// In the world of `directory`, with the networks of `trained`. `fcd`: where SUMO's trajectories go;
// empty for none.
ProcessPlan evaluation_process(const EvaluationJob& job, const RunDirectory& directory,
                               const RunDirectory& trained, const std::filesystem::path& programs,
                               const std::filesystem::path& fcd);
// Looks back on the collisions of what an evaluation in `directory` wrote.
ProcessPlan hindsight_process(const EvaluationJob& job, const HindsightLimits& limits,
                              const RunDirectory& directory, const std::filesystem::path& programs);
}  // namespace corridor::cluster
