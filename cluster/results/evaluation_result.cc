#include "cluster/results/evaluation_result.h"

#include <algorithm>

#include "proto/base/failure.h"
#include "proto/base/json.h"
#include "proto/run/run_directory.h"
#include "proto/settings/planner_pairs.h"
#include "proto/system/files.h"

namespace corridor::cluster {
namespace {

template <typename T>
void read(const Json& value, T& into) {
  if constexpr (std::integral<T>) {
    into = whole_number<T>(value);
  } else {
    value.get_to(into);
  }
}

EpisodeResult parse_episode(const Json& entry) {
  EpisodeResult result;
  read(entry.at("steps"), result.steps);
  read(entry.at("bp_reward"), result.bp_reward);
  read(entry.at("mop_reward"), result.mop_reward);
  read(entry.at("collisions"), result.collisions);
  read(entry.at("lane_changes"), result.lane_changes);
  read(entry.at("hard_brakes"), result.hard_brakes);
  read(entry.at("bypasses"), result.bypasses);
  read(entry.at("distance_m"), result.distance_m);
  result.lane_steps = whole_numbers<std::int64_t>(entry.at("lane_steps"));
  return result;
}

}  // namespace

double EvaluationResult::step_s() const {
  if (mean_speed_kph <= 0.0) return 1.0;
  return 3600.0 * distance_km / mean_speed_kph / static_cast<double>(steps);
}

EvaluationResult parse_evaluation(const Json& json, const std::string& name) {
  EvaluationResult result;
  try {
    read(json.at("planner"), result.planner);
    planner_pair(result.planner);
    read(json.at("seed"), result.seed);
    read(json.at("steps"), result.steps);
    read(json.at("episodes"), result.episodes);
    read(json.at("bp_reward_per_1000"), result.bp_reward_per_1000);
    read(json.at("collisions"), result.collisions);
    for (std::size_t kind = 0; kind < kCollisionKinds.size(); ++kind) {
      read(json.at("collisions_by_kind").at(kCollisionKinds[kind]),
           result.collisions_by_kind[kind]);
    }
    read(json.at("lane_changes"), result.lane_changes);
    read(json.at("bypasses"), result.bypasses);
    read(json.at("mean_speed_kph"), result.mean_speed_kph);
    read(json.at("distance_km"), result.distance_km);
    for (const auto& entry : json.at("per_episode")) {
      result.per_episode.push_back(parse_episode(entry));
      if (result.per_episode.back().steps <= 0) throw Failure("an episode of no steps");
    }
    if (result.steps <= 0) throw Failure("no steps");
    if ((result.distance_km > 0.0) != (result.mean_speed_kph > 0.0)) {
      throw Failure("{} km at {} km/h", result.distance_km, result.mean_speed_kph);
    }
  } catch (const std::exception& error) {
    throw Failure("{} is no evaluation: {}", name, error.what());
  }
  if (result.per_episode.empty()) throw Failure("{} is no evaluation: it has no episodes", name);
  return result;
}

EvaluationResult read_evaluation(const std::filesystem::path& file) {
  return parse_evaluation(read_json(file), file.string());
}

OrderedJson evaluation_json(const std::vector<EvaluationResult>& results) {
  OrderedJson list = OrderedJson::array();
  for (const EvaluationResult& result : results) {
    OrderedJson kinds = OrderedJson::object();
    for (std::size_t kind = 0; kind < kCollisionKinds.size(); ++kind) {
      kinds[kCollisionKinds[kind]] = result.collisions_by_kind[kind];
    }
    list.push_back({{"planner", result.planner},
                    {"seed", result.seed},
                    {"steps", result.steps},
                    {"episodes", result.episodes},
                    {"bp_reward_per_1000", result.bp_reward_per_1000},
                    {"collisions", result.collisions},
                    {"collisions_by_kind", kinds},
                    {"lane_changes", result.lane_changes},
                    {"bypasses", result.bypasses},
                    {"mean_speed_kph", result.mean_speed_kph},
                    {"distance_km", result.distance_km}});
  }
  return list;
}

std::vector<EvaluationResult> read_evaluations(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code missing;
  for (const auto& entry : std::filesystem::directory_iterator(folder, missing)) {
    if (entry.is_regular_file() && entry.path().extension() == ".json") files.push_back(entry);
  }
  std::sort(files.begin(), files.end());
  std::vector<EvaluationResult> results;
  for (const auto& file : files) results.push_back(read_evaluation(file));
  return results;
}

}  // namespace corridor::cluster
