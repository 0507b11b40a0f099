// SPDX-License-Identifier: Apache-2.0
// What a greedy evaluation came to: evaluation/<planner>_<seed>.json. An actor writes it; the
// tables and pictures are made from it.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "proto/base/json_fwd.h"
#include "proto/run/episode_name.h"
#include "proto/run/run_directory.h"
#include "proto/settings/collision_kinds.h"

namespace corridor {

// Rewards and counts are totals of the episode.
struct EpisodeRecord {
  std::int64_t steps = 0;
  double bp_reward = 0.0;
  double mop_reward = 0.0;
  std::int64_t collisions = 0;  // 0, or 1, which ended it
  std::int64_t lane_changes = 0;
  std::int64_t hard_brakes = 0;
  double distance_m = 0.0;
  std::vector<std::int64_t> lane_steps;  // by lane, from the right
  std::int64_t bypasses = 0;             // vehicles and objects passed within the lane
  std::optional<CollisionKind> collision_kind = {};
  std::uint64_t episode = 0;  // its index in the evaluation

  template <typename Self, typename Field>
  static void fields(Self& self, Field field) {
    field("episode", self.episode);
    field("steps", self.steps);
    field("bp_reward", self.bp_reward);
    field("mop_reward", self.mop_reward);
    field("collisions", self.collisions);
    field("collision_kind", self.collision_kind);
    field("lane_changes", self.lane_changes);
    field("hard_brakes", self.hard_brakes);
    field("bypasses", self.bypasses);
    field("distance_m", self.distance_m);
    field("lane_steps", self.lane_steps);
  }
  void check() const;
  bool operator==(const EpisodeRecord&) const = default;
};

struct CollisionCounts : std::array<std::int64_t, kCollisionKinds> {  // by CollisionKind
  template <typename Self, typename Field>
  static void fields(Self& self, Field field) {
    for (std::size_t i = 0; i < kCollisionKinds; ++i)
      field(kChoices<CollisionKind>[i].name, self[i]);
  }
};

// One planner pair on the test episodes of one evaluation seed. Counts are totals over the steps.
struct EvaluationRecord {
  std::string planner;
  std::uint64_t seed = 0;
  std::int64_t steps = 0;
  std::int64_t episodes = 0;
  double bp_reward_per_1000 = 0.0;
  std::int64_t collisions = 0;
  CollisionCounts collisions_by_kind{};
  std::int64_t lane_changes = 0;
  std::int64_t bypasses = 0;
  double mean_speed_kph = 0.0;
  double distance_km = 0.0;
  double step_s = 1.0;  // of the planners
  std::vector<EpisodeRecord> per_episode;

  EvaluationName name() const { return {planner, seed}; }

  template <typename Self, typename Field>
  static void totals(Self& self, Field field) {
    field("planner", self.planner);
    field("seed", self.seed);
    field("steps", self.steps);
    field("episodes", self.episodes);
    field("bp_reward_per_1000", self.bp_reward_per_1000);
    field("collisions", self.collisions);
    field("collisions_by_kind", self.collisions_by_kind);
    field("lane_changes", self.lane_changes);
    field("bypasses", self.bypasses);
    field("mean_speed_kph", self.mean_speed_kph);
    field("distance_km", self.distance_km);
  }
  template <typename Self, typename Field>
  static void fields(Self& self, Field field) {
    totals(self, field);
    field("step_s", self.step_s);
    field("per_episode", self.per_episode);
  }
  void check() const;
  bool operator==(const EvaluationRecord&) const = default;
};

// The totals of these episodes.
EvaluationRecord evaluation_of(const EvaluationName& name, double step_s,
                               std::vector<EpisodeRecord> per_episode);

// The totals, in the order of totals(), for other programs.
OrderedJson totals_json(const EvaluationRecord& record);

// Throws Failure when the disk is full.
void write_evaluation(const RunDirectory& directory, const EvaluationRecord& record);

// Throws Failure naming the file when a member is missing or wrong, when there is no such planner
// pair, or no episode.
EvaluationRecord read_evaluation(const std::filesystem::path& file);
// All in RunDirectory::evaluation(), by file name; none where there is no such folder.
std::vector<EvaluationRecord> read_evaluations(const std::filesystem::path& folder);

}  // namespace corridor
