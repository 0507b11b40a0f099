// SPDX-License-Identifier: Apache-2.0
#include "proto/run/evaluation_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/run/json_record.h"
#include "proto/system/files.h"
#include "tests/support/refused_records.h"
#include "tests/support/temporary_directory.h"

namespace corridor {
namespace {

using testing::HasSubstr;
using testing_support::expect_every_member_is_needed;
using testing_support::expect_refused;

// 1500 steps of half a second at 25 m/s.
EvaluationRecord evaluation(const std::string& planner = "rules", std::uint64_t seed = 7) {
  EpisodeRecord whole{1000, 650.0, 700.0, 0, 20, 5, 12500.0, {1000, 0, 0}, 3};
  EpisodeRecord collided{
      500, 250.0, 300.0, 1, 20, 5, 6250.0, {400, 100, 0}, 1, CollisionKind::kSideByOther, 1};
  return evaluation_of({planner, seed}, 0.5, {whole, collided});
}

const auto read = [](const Json& json) {
  parse_record<EvaluationRecord>(json, "rules_7.json", "evaluation");
};

TEST(EvaluationRecord, SumsUpItsEpisodes) {
  const EvaluationRecord record = evaluation();
  EXPECT_EQ(record.steps, 1500);
  EXPECT_EQ(record.episodes, 2);
  EXPECT_DOUBLE_EQ(record.bp_reward_per_1000, 600.0);
  EXPECT_EQ(record.collisions, 1);
  EXPECT_EQ(record.collisions_by_kind[static_cast<std::size_t>(CollisionKind::kSideByOther)], 1);
  EXPECT_EQ(record.collisions_by_kind[static_cast<std::size_t>(CollisionKind::kRearEnded)], 0);
  EXPECT_EQ(record.lane_changes, 40);
  EXPECT_EQ(record.bypasses, 4);
  EXPECT_DOUBLE_EQ(record.mean_speed_kph, 90.0);
  EXPECT_DOUBLE_EQ(record.distance_km, 18.75);
}

TEST(EvaluationRecord, IsReadAsItWasWritten) {
  const testing_support::TemporaryDirectory temporary;
  const RunDirectory run = RunDirectory::create(temporary.path() / "run");
  write_evaluation(run, evaluation("sumo", 8));
  write_evaluation(run, evaluation("rules", 7));
  EXPECT_EQ(read_evaluation(run.evaluation() / "rules_7.json"), evaluation());
  EXPECT_THAT(read_evaluations(run.evaluation()),
              testing::ElementsAre(evaluation("rules", 7), evaluation("sumo", 8)));
  EXPECT_THAT(read_evaluations(run.root() / "nothing"), testing::IsEmpty());
}

// The file's form is what people's scripts read.
TEST(EvaluationRecord, HasTheDocumentedMembers) {
  Json json = json_of(evaluation());
  const Json episodes = json["per_episode"];
  json.erase("per_episode");
  EXPECT_EQ(json, Json::parse(R"({"planner": "rules", "seed": 7, "step_s": 0.5, "steps": 1500,
      "episodes": 2, "bp_reward_per_1000": 600.0, "collisions": 1, "collisions_by_kind":
      {"rear_ended": 0, "rear_ending": 0, "side_by_other": 1, "side_by_ego": 0, "off_road": 0},
      "lane_changes": 40, "bypasses": 4, "mean_speed_kph": 90.0, "distance_km": 18.75})"));
  EXPECT_EQ(episodes[1], Json::parse(R"({"episode": 1, "steps": 500, "bp_reward": 250.0,
      "mop_reward": 300.0, "collisions": 1, "collision_kind": "side_by_other", "lane_changes": 20,
      "hard_brakes": 5, "bypasses": 1, "distance_m": 6250.0, "lane_steps": [400, 100, 0]})"));
  EXPECT_TRUE(episodes[0].at("collision_kind").is_null());
}

TEST(EvaluationRecord, GivesItsTotalsOnInTheirOrder) {
  const OrderedJson totals = totals_json(evaluation());
  std::string names;
  for (const auto& [name, value] : totals.items()) names += name + " ";
  EXPECT_EQ(names,
            "planner seed steps episodes bp_reward_per_1000 collisions collisions_by_kind "
            "lane_changes bypasses mean_speed_kph distance_km ");
}

TEST(EvaluationRecord, IsRefusedWhenAMemberIsMissingOrWrong) {
  const Json json = json_of(evaluation());
  expect_every_member_is_needed(json, read);
  expect_refused(json, "/lane_changes", "many", "rules_7.json is no evaluation: lane_changes",
                 read);
  expect_refused(json, "/collisions_by_kind/side_by_ego", 0.5, "side_by_ego", read);
  expect_refused(json, "/planner", "flying", "flying", read);
  expect_refused(json, "/steps", 0, "no steps", read);
  for (const char* total : {"/steps", "/episodes", "/collisions", "/lane_changes", "/bypasses",
                            "/collisions_by_kind/side_by_ego"}) {
    expect_refused(json, total, 77, "its totals are not those of its episodes", read);
  }
  expect_refused(json, "/per_episode/0/bypasses", -1, "a count of -1", read);
  expect_refused(json, "/per_episode/0/lane_steps/0", 1LL << 62, "a count of", read);
  expect_refused(json, "/step_s", 0.0, "steps of 0 s", read);
  expect_refused(json, "/per_episode", Json::array(), "no episodes", read);
  expect_refused(json, "/per_episode/0/steps", 0, "no steps", read);
  expect_refused(json, "/per_episode/0/steps", 1e87, "steps", read);
  expect_refused(json, "/per_episode/1/collision_kind", "dented", "must be one of", read);
  expect_refused(json, "/per_episode/0/collisions", 1, "1 collisions", read);
  EXPECT_THAT(failure_of([] { read(Json::array()); }), HasSubstr("is no evaluation"));
}

}  // namespace
}  // namespace corridor
