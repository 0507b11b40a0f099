#include "actor/look_back.h"

#include <algorithm>
#include <vector>

#include "proto/base/failure.h"
#include "proto/base/json.h"
#include "proto/settings/collision_kinds.h"
#include "proto/system/files.h"

namespace corridor::actor {
namespace {

struct Evaluated {
  std::int64_t steps = 0;
  std::vector<std::uint64_t> collisions;  // their episodes
};

Evaluated read_evaluated(const std::filesystem::path& file) {
  const Json totals = read_json(file);
  Evaluated evaluated;
  try {
    evaluated.steps = whole_number<std::int64_t>(totals.at("steps"));
    for (const Json& episode : totals.at("per_episode")) {
      if (whole_number<int>(episode.at("collisions")) == 0) continue;
      evaluated.collisions.push_back(whole_number<std::uint64_t>(episode.at("episode")));
    }
  } catch (const std::exception& error) {
    throw Failure("{} is no evaluation: {}", file.string(), error.what());
  }
  return evaluated;
}

Json last_actions(const RecordedEpisode& recorded, int count) {
  const auto kept = std::min(static_cast<std::size_t>(count), recorded.actions.size());
  Json actions = Json::array();
  for (std::size_t i = recorded.actions.size() - kept; i < recorded.actions.size(); ++i) {
    actions.push_back(driving::unpack(recorded.actions[i]).mop_action);
  }
  return actions;
}

Json collision_json(const Hindsight& hindsight, int actions) {
  Json verdicts = Json::array(), attempts = Json::array();
  for (int i = 1; i <= actions; ++i) verdicts.push_back(verdict_name(hindsight.by_last(i)));
  for (const EscapeSearch& search : hindsight.searches) attempts.push_back(search.attempts);
  return {{"collision_kind", name_of(hindsight.collision.kind)},
          {"step", hindsight.step},
          {"actions_in_sight", hindsight.actions_in_sight},
          {"by_reacting", verdict_name(hindsight.by_reacting())},
          {"by_last_actions", verdicts},
          {"attempts", attempts},
          {"escape", hindsight.searches.back().escape}};
}

}  // namespace

void report_hindsight(const RunConfig& config, const HindsightTask& task,
                      const RunDirectory& directory, world::World& world,
                      const std::function<bool(std::size_t, std::size_t)>& progress) {
  const std::string name = fmt::format("{}_{}", task.planner, task.seed);
  const Evaluated evaluated = read_evaluated(directory.evaluation() / (name + ".json"));
  Json collisions = Json::array();
  for (const std::uint64_t episode : evaluated.collisions) {
    const RecordedEpisode recorded = read_recorded_episode(
        config, directory.episodes() / fmt::format("{}_{}.json", name, episode));
    const Hindsight hindsight = look_back(config, recorded, world, task.limits);
    Json collision = collision_json(hindsight, task.limits.actions);
    collision["episode"] = episode;
    collision["recorded"] = last_actions(recorded, task.limits.actions);
    collisions.push_back(std::move(collision));
    if (!progress(collisions.size(), evaluated.collisions.size())) return;
  }
  const Json report = {{"planner", task.planner},
                       {"seed", task.seed},
                       {"steps", evaluated.steps},
                       {"actions", task.limits.actions},
                       {"attempts_max", task.limits.attempts_max},
                       {"collisions", collisions}};
  on_disk("create", directory.hindsight(),
          [&] { std::filesystem::create_directories(directory.hindsight()); });
  write_file(directory.hindsight() / (name + ".json"), report.dump(1) + "\n");
}

}  // namespace corridor::actor
