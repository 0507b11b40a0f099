// SPDX-License-Identifier: Apache-2.0
#include "proto/run/evaluation_record.h"

#include <algorithm>
#include <tuple>

#include "proto/base/failure.h"
#include "proto/base/text.h"
#include "proto/run/json_record.h"
#include "proto/settings/limits.h"
#include "proto/settings/planner_pairs.h"
#include "proto/system/files.h"

namespace corridor {

void EpisodeRecord::check() const {
  if (steps <= 0) throw Failure("an episode of no steps");
  if (collisions != (collision_kind ? 1 : 0)) {
    throw Failure("{} collisions, {} of a kind", collisions, collision_kind ? 1 : 0);
  }
  std::vector<std::int64_t> counts = lane_steps;
  counts.insert(counts.end(), {steps, lane_changes, hard_brakes, bypasses});
  for (const std::int64_t count : counts) {
    if (count < 0 || count > kStepsMax) throw Failure("a count of {}", count);
  }
}

void EvaluationRecord::check() const {
  planner_pair(planner);
  if (steps <= 0) throw Failure("no steps");
  if (!(step_s > 0.0)) throw Failure("steps of {} s", step_s);
  if (per_episode.empty()) throw Failure("it has no episodes");
  const EvaluationRecord sums = evaluation_of(name(), step_s, per_episode);
  const auto counts = [](const EvaluationRecord& of) {
    return std::tuple(of.steps, of.episodes, of.collisions, of.lane_changes, of.bypasses,
                      of.collisions_by_kind);
  };
  if (counts(*this) != counts(sums)) throw Failure("its totals are not those of its episodes");
}

EvaluationRecord evaluation_of(const EvaluationName& name, double step_s,
                               std::vector<EpisodeRecord> per_episode) {
  EvaluationRecord record;
  record.planner = name.planner;
  record.seed = name.seed;
  record.step_s = step_s;
  double bp_reward = 0.0, distance_m = 0.0;
  for (const EpisodeRecord& episode : per_episode) {
    record.steps += episode.steps;
    record.collisions += episode.collisions;
    record.lane_changes += episode.lane_changes;
    record.bypasses += episode.bypasses;
    bp_reward += episode.bp_reward;
    distance_m += episode.distance_m;
    if (episode.collision_kind) {
      ++record.collisions_by_kind[static_cast<std::size_t>(*episode.collision_kind)];
    }
  }
  const double time_s = static_cast<double>(record.steps) * step_s;
  record.episodes = static_cast<std::int64_t>(per_episode.size());
  record.bp_reward_per_1000 = 1000.0 * bp_reward / static_cast<double>(record.steps);
  record.mean_speed_kph = kKphPerMps * distance_m / time_s;
  record.distance_km = distance_m / 1000.0;
  record.per_episode = std::move(per_episode);
  return record;
}

OrderedJson totals_json(const EvaluationRecord& record) {
  OrderedJson json = OrderedJson::object();
  EvaluationRecord::totals(record, [&](const char* name, const auto& member) {
    json[name] = json_of<OrderedJson>(member);
  });
  return json;
}

void write_evaluation(const RunDirectory& directory, const EvaluationRecord& record) {
  write_file(directory.evaluation(record.name()), json_of(record).dump(1));
}

EvaluationRecord read_evaluation(const std::filesystem::path& file) {
  return parse_record<EvaluationRecord>(read_json(file), file.string(), "evaluation");
}

std::vector<EvaluationRecord> read_evaluations(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code missing;
  for (const auto& entry : std::filesystem::directory_iterator(folder, missing)) {
    if (entry.is_regular_file() && entry.path().extension() == ".json") files.push_back(entry);
  }
  std::sort(files.begin(), files.end());
  std::vector<EvaluationRecord> records;
  for (const auto& file : files) records.push_back(read_evaluation(file));
  return records;
}

}  // namespace corridor
