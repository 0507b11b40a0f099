// SPDX-License-Identifier: Apache-2.0
// Recorded episodes (proto/run/recorded_episode.h), driven again.
#pragma once

#include <filesystem>
#include <functional>

#include "actor/episode.h"
#include "actor/world/world.h"
#include "proto/run/recorded_episode.h"
#include "proto/settings/settings.h"

namespace corridor::actor {

// Throws Failure when the file is no episode, or has actions that this configuration does not.
RecordedEpisode read_own_episode(const RunConfig& config, const std::filesystem::path& file);

world::EpisodeStart start_of(const RecordedEpisode& recorded);

// The next step of an episode that has been driven as recorded so far.
StepOutcome step_as_recorded(Episode& episode, const RecordedEpisode& recorded);

// The whole episode, from `start`, which is start_of(recorded) and what is to be seen of it, and
// leaves it open. `seen` is called at the start and after each step.
void drive_as_recorded(Episode& episode, const RecordedEpisode& recorded,
                       const world::EpisodeStart& start, const std::function<void()>& seen);

// Of an episode that was driven so. Throws Failure when its trajectory is not the recorded one.
void check_as_recorded(const Episode& episode, const RecordedEpisode& recorded);

struct Redriven {
  EpisodeSummary summary;
  std::string trajectory_hash;
  bool as_recorded = false;
};
// Throws Failure as read_own_episode does. `fcd_output`: a file; empty for none.
Redriven redrive(const RunConfig& config, const std::filesystem::path& file, world::World& world,
                 const std::filesystem::path& fcd_output);

}  // namespace corridor::actor
