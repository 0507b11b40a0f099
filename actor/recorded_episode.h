// An episode as an evaluation recorded it (actor/evaluation.h), and driving it again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "actor/episode.h"
#include "actor/world/world.h"
#include "proto/settings/settings.h"

namespace corridor::actor {

struct RecordedEpisode {
  std::filesystem::path file;
  std::string planner;
  world::EpisodeStart start;
  std::vector<std::uint8_t> actions;  // one a step; none where the world drives
  int steps = 0;
  std::uint64_t trajectory_hash = 0;

  bool driven_by_world() const { return start.driver == world::EgoDriver::kWorld; }
};

// Throws Failure when the file is no episode, or has actions that this configuration does not.
RecordedEpisode read_recorded_episode(const RunConfig& config, const std::filesystem::path& file);

// The next step of an episode that has been driven as recorded so far.
StepOutcome step_as_recorded(Episode& episode, const RecordedEpisode& recorded);

// The whole episode, from its start, and leaves it open. `seen` is called at the start and after
// each step.
void drive_as_recorded(Episode& episode, const RecordedEpisode& recorded,
                       const std::function<void()>& seen);

// Of an episode that was driven so. Throws Failure when its trajectory is not the recorded one.
void check_as_recorded(const Episode& episode, const RecordedEpisode& recorded);

}  // namespace corridor::actor
