// What corridor-actor wrote about its greedy episodes, as values; the JSON for others.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "proto/base/json_fwd.h"
#include "proto/settings/collision_kinds.h"

namespace corridor::cluster {

struct EpisodeResult {
  std::int64_t steps = 0;
  double bp_reward = 0.0;
  double mop_reward = 0.0;
  std::int64_t collisions = 0;
  std::int64_t lane_changes = 0;
  std::int64_t hard_brakes = 0;
  double distance_m = 0.0;
  std::vector<std::int64_t> lane_steps;  // by lane, from the right
  std::int64_t bypasses = 0;             // vehicles and objects passed within the lane
};

// One planner pair on the test episodes of one evaluation seed. Counts are totals over the steps.
struct EvaluationResult {
  std::string planner;
  std::uint64_t seed = 0;
  std::int64_t steps = 0;
  std::int64_t episodes = 0;
  double bp_reward_per_1000 = 0.0;
  std::int64_t collisions = 0;
  std::array<std::int64_t, kCollisionKinds.size()> collisions_by_kind{};
  std::int64_t lane_changes = 0;
  std::int64_t bypasses = 0;
  double mean_speed_kph = 0.0;
  double distance_km = 0.0;
  std::vector<EpisodeResult> per_episode;

  // The simulation's step, from distance, mean speed and steps; 1 when the ego stood still.
  double step_s() const;
};

// Throws Failure naming `name` (the file) when a field is missing or wrong, when there is no such
// planner pair, or no episode.
EvaluationResult parse_evaluation(const Json& json, const std::string& name);
EvaluationResult read_evaluation(const std::filesystem::path& file);
// All of a run, by file name; none where there is no such folder.
std::vector<EvaluationResult> read_evaluations(const std::filesystem::path& folder);

// A list with one object a result: all fields but the episodes.
OrderedJson evaluation_json(const std::vector<EvaluationResult>& results);

}  // namespace corridor::cluster
