// SPDX-License-Identifier: Apache-2.0
#include "actor/redrive.h"

#include "actor/driving/action.h"
#include "proto/base/failure.h"

namespace corridor::actor {

RecordedEpisode read_own_episode(const RunConfig& config, const std::filesystem::path& file) {
  RecordedEpisode recorded = read_recorded_episode(file);
  const int mop_actions = config.shape(Phase::kMop).actions;
  for (const std::uint8_t action : recorded.actions) {
    if (driving::unpack(action).mop_action >= mop_actions) {
      throw Failure("{} has an action that this run's planner does not have: it is of another run",
                    file.string());
    }
  }
  return recorded;
}

world::EpisodeStart start_of(const RecordedEpisode& recorded) {
  world::EpisodeStart start{.seed = recorded.episode_seed};
  if (recorded.driven_by_world) start.driver = world::EgoDriver::kWorld;
  return start;
}

StepOutcome step_as_recorded(Episode& episode, const RecordedEpisode& recorded) {
  if (recorded.driven_by_world) return episode.step_by_world();
  const auto step = static_cast<std::size_t>(episode.summary().steps);
  CORRIDOR_CHECK(step < recorded.actions.size(), "step {} of {}", step, recorded.actions.size());
  const driving::StepAction action = driving::unpack(recorded.actions[step]);
  return episode.step(action.command, action.mop_action);
}

void drive_as_recorded(Episode& episode, const RecordedEpisode& recorded,
                       const world::EpisodeStart& start, const std::function<void()>& seen) {
  episode.begin(start);
  seen();
  bool ended = false;
  for (std::int64_t i = 0; i < recorded.summary.steps && !ended; ++i) {
    ended = step_as_recorded(episode, recorded).episode_ended;
    seen();
  }
}

void check_as_recorded(const Episode& episode, const RecordedEpisode& recorded) {
  if (episode.trajectory_hash() == recorded.trajectory_hash) return;
  throw Failure("{} does not drive again as recorded: it is of another configuration or SUMO",
                recorded.name().text());
}

Redriven redrive(const RunConfig& config, const std::filesystem::path& file, world::World& world,
                 const std::filesystem::path& fcd_output) {
  const RecordedEpisode recorded = read_own_episode(config, file);
  world::EpisodeStart start = start_of(recorded);
  start.fcd_output = fcd_output;
  Episode episode(config, world);
  drive_as_recorded(episode, recorded, start, [] {});
  episode.end();
  const std::string hash = episode.trajectory_hash();
  return {episode.summary(), hash, hash == recorded.trajectory_hash};
}

}  // namespace corridor::actor
