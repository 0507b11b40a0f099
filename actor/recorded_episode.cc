#include "actor/recorded_episode.h"

#include "proto/base/failure.h"
#include "proto/base/json.h"
#include "proto/run/run_directory.h"
#include "proto/system/files.h"

namespace corridor::actor {

RecordedEpisode read_recorded_episode(const RunConfig& config, const std::filesystem::path& file) {
  const Json record = read_json(file);
  RecordedEpisode recorded;
  recorded.file = file;
  try {
    recorded.planner = record.at("planner").get<std::string>();
    recorded.start.seed = whole_number<std::uint64_t>(record.at("episode_seed"));
    if (record.at("driven_by_world").get<bool>()) {
      recorded.start.driver = world::EgoDriver::kWorld;
    }
    recorded.actions = whole_numbers<std::uint8_t>(record.at("actions"));
    recorded.steps = whole_number<int>(record.at("summary").at("steps"));
    recorded.trajectory_hash =
        std::stoull(record.at("trajectory_hash").get<std::string>(), nullptr, 16);
  } catch (const std::exception& error) {
    throw Failure("{} is no recorded episode: {}", file.string(), error.what());
  }
  if (!recorded.driven_by_world() &&
      recorded.actions.size() != static_cast<std::size_t>(recorded.steps)) {
    throw Failure("{} is damaged: {} actions for {} steps", file.string(), recorded.actions.size(),
                  recorded.steps);
  }
  const int mop_actions = config.shape(Phase::kMop).actions;
  for (const std::uint8_t action : recorded.actions) {
    if (driving::unpack(action).mop_action >= mop_actions) {
      throw Failure("{} has an action that this run's planner does not have: it is of another run",
                    file.string());
    }
  }
  return recorded;
}

StepOutcome step_as_recorded(Episode& episode, const RecordedEpisode& recorded) {
  if (recorded.driven_by_world()) return episode.step_by_world();
  const auto step = static_cast<std::size_t>(episode.summary().steps);
  CORRIDOR_CHECK(step < recorded.actions.size(), "step {} of {}", step, recorded.actions.size());
  const driving::StepAction action = driving::unpack(recorded.actions[step]);
  return episode.step(action.command, action.mop_action);
}

void drive_as_recorded(Episode& episode, const RecordedEpisode& recorded,
                       const std::function<void()>& seen) {
  episode.begin(recorded.start);
  seen();
  bool ended = false;
  for (int i = 0; i < recorded.steps && !ended; ++i) {
    ended = step_as_recorded(episode, recorded).episode_ended;
    seen();
  }
}

void check_as_recorded(const Episode& episode, const RecordedEpisode& recorded) {
  if (episode.trajectory_hash() == recorded.trajectory_hash) return;
  throw Failure("{} does not drive again as recorded: it is of another configuration or SUMO",
                recorded.file.string());
}

}  // namespace corridor::actor
