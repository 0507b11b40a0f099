#include "actor/evaluation.h"

#include "actor/recorded_episode.h"
#include "proto/base/failure.h"
#include "proto/base/json.h"
#include "proto/settings/collision_kinds.h"
#include "proto/system/files.h"

namespace corridor::actor {
namespace {

constexpr double kKphPerMps = 3.6;

std::string hex(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

Json summary_json(const EpisodeSummary& summary, std::uint64_t episode) {
  return {{"episode", episode},
          {"steps", summary.steps},
          {"bp_reward", summary.bp_reward},
          {"mop_reward", summary.mop_reward},
          {"collisions", summary.collision ? 1 : 0},
          {"collision_kind",
           summary.collision ? Json(name_of(summary.collision->kind)) : Json(nullptr)},
          {"lane_changes", summary.lane_changes},
          {"hard_brakes", summary.hard_brakes},
          {"bypasses", summary.bypasses},
          {"distance_m", summary.distance_m},
          {"lane_steps", summary.lane_steps}};
}

Json totals_json(const RunConfig& config, const EvaluationTask& task, const Json& per_episode) {
  std::int64_t steps = 0, collisions = 0, lane_changes = 0, bypasses = 0;
  double bp_reward = 0.0, distance_m = 0.0;
  Json by_kind = Json::object();
  for (const char* kind : kCollisionKinds) by_kind[kind] = 0;
  for (const Json& episode : per_episode) {
    steps += episode["steps"].get<std::int64_t>();
    collisions += episode["collisions"].get<std::int64_t>();
    lane_changes += episode["lane_changes"].get<std::int64_t>();
    bypasses += episode["bypasses"].get<std::int64_t>();
    bp_reward += episode["bp_reward"].get<double>();
    distance_m += episode["distance_m"].get<double>();
    const Json& kind = episode["collision_kind"];
    if (!kind.is_null()) {
      Json& count = by_kind[kind.get<std::string>()];
      count = count.get<int>() + 1;
    }
  }
  const double time_s = static_cast<double>(steps) * config.simulation.step_s;
  return {{"planner", task.pair.name},
          {"seed", task.seed},
          {"steps", steps},
          {"episodes", per_episode.size()},
          {"bp_reward_per_1000", 1000.0 * bp_reward / static_cast<double>(steps)},
          {"collisions", collisions},
          {"collisions_by_kind", by_kind},
          {"lane_changes", lane_changes},
          {"bypasses", bypasses},
          {"mean_speed_kph", kKphPerMps * distance_m / time_s},
          {"distance_km", distance_m / 1000.0},
          {"per_episode", per_episode}};
}

Json episode_json(const EvaluationTask& task, std::uint64_t index, std::uint64_t seed,
                  const Episode& episode) {
  return {{"planner", task.pair.name},
          {"evaluation_seed", task.seed},
          {"episode", index},
          {"episode_seed", seed},
          {"driven_by_world", task.pair.world_drives()},
          {"actions", episode.actions()},
          {"trajectory_hash", hex(episode.trajectory_hash())},
          {"summary", summary_json(episode.summary(), index)}};
}

}  // namespace

void evaluate(const RunConfig& config, const Networks& networks, const EvaluationTask& task,
              const RunDirectory& directory, world::World& world,
              const std::function<bool(std::int64_t)>& progress) {
  const auto bp = make_behaviour_planner(task.pair, config, networks);
  const auto mop = make_motion_planner(task.pair, config, networks);
  const std::string name = fmt::format("{}_{}", task.pair.name, task.seed);
  std::filesystem::create_directories(directory.episodes());
  if (!task.fcd_directory.empty()) std::filesystem::create_directories(task.fcd_directory);

  Episode episode(config, world);
  Json per_episode = Json::array();
  std::int64_t steps = 0;
  for (std::uint64_t index = 0; steps < task.steps; ++index) {
    world::EpisodeStart start{.seed = test_episode_seed(task.seed, index)};
    if (!task.fcd_directory.empty()) {
      start.fcd_output = task.fcd_directory / fmt::format("{}_{}.fcd.xml", name, index);
    }
    if (task.pair.world_drives()) {
      start.driver = world::EgoDriver::kWorld;
      drive_by_world(episode, start, task.steps - steps);
    } else {
      drive(episode, start, *bp, *mop, task.steps - steps);
    }
    episode.end();
    steps += episode.summary().steps;
    per_episode.push_back(summary_json(episode.summary(), index));
    write_file(directory.episodes() / fmt::format("{}_{}.json", name, index),
               episode_json(task, index, start.seed, episode).dump());
    if (!progress(steps)) return;
  }
  write_file(directory.evaluation() / (name + ".json"),
             totals_json(config, task, per_episode).dump(1));
}

Redriven redrive(const RunConfig& config, const std::filesystem::path& file, world::World& world,
                 const std::filesystem::path& fcd_output) {
  RecordedEpisode recorded = read_recorded_episode(config, file);
  recorded.start.fcd_output = fcd_output;
  Episode episode(config, world);
  drive_as_recorded(episode, recorded, [] {});
  episode.end();
  return {recorded.trajectory_hash, episode.trajectory_hash(), episode.summary()};
}

}  // namespace corridor::actor
