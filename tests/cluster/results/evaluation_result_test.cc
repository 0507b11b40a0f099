#include "cluster/results/evaluation_result.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/base/failure.h"
#include "proto/base/json.h"

namespace corridor::cluster {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

Json episode(int steps, double reward, int collisions) {
  return {{"episode", 0},
          {"steps", steps},
          {"bp_reward", reward},
          {"mop_reward", 0},
          {"lane_changes", 20},
          {"collisions", collisions},
          {"hard_brakes", 5},
          {"bypasses", 3},
          {"distance_m", 12.5 * steps},
          {"lane_steps", {steps, 0, 0}}};
}

Json evaluation(const std::string& planner, std::uint64_t seed) {
  return {{"planner", planner},
          {"seed", seed},
          {"steps", 1500},
          {"episodes", 2},
          {"bp_reward_per_1000", 600.0},
          {"collisions", 1},
          {"collisions_by_kind",
           {{"rear_ended", 0},
            {"rear_ending", 0},
            {"side_by_other", 1},
            {"side_by_ego", 0},
            {"off_road", 0}}},
          {"lane_changes", 40},
          {"bypasses", 6},
          {"mean_speed_kph", 45.0},
          {"distance_km", 18.75},
          {"per_episode", {episode(1000, 650.0, 0), episode(500, 250.0, 1)}}};
}

TEST(EvaluationJson, HasOneObjectAResultWithTheDocumentedFieldsInOrder) {
  const auto list = evaluation_json({parse_evaluation(evaluation("rules", 7), "a"),
                                     parse_evaluation(evaluation("sumo", 8), "b")});
  ASSERT_EQ(list.size(), 2u);
  std::string keys;
  for (const auto& [key, value] : list[0].items()) keys += key + " ";
  EXPECT_EQ(keys,
            "planner seed steps episodes bp_reward_per_1000 collisions collisions_by_kind "
            "lane_changes bypasses mean_speed_kph distance_km ");
  Json expected = evaluation("sumo", 8);
  expected.erase("per_episode");
  EXPECT_EQ(Json::parse(list[1].dump()), expected);
}

TEST(EvaluationFile, TellsTheTimeStepByItsSpeed) {
  EXPECT_DOUBLE_EQ(parse_evaluation(evaluation("rules", 7), "a").step_s(), 1.0);
  Json faster = evaluation("rules", 7);
  faster["mean_speed_kph"] = 90.0;
  EXPECT_DOUBLE_EQ(parse_evaluation(faster, "a").step_s(), 0.5);
  Json standing = evaluation("rules", 7);
  standing["mean_speed_kph"] = standing["distance_km"] = 0.0;
  EXPECT_EQ(parse_evaluation(standing, "a").step_s(), 1.0);
}

TEST(EvaluationFile, IsRefusedWhenAFieldIsMissingWrongOrWithoutEpisodes) {
  Json missing = evaluation("rules", 7);
  missing.erase("lane_changes");
  EXPECT_THAT([&] { parse_evaluation(missing, "rules_7.json"); },
              ThrowsMessage<Failure>(
                  AllOf(HasSubstr("rules_7.json is no evaluation"), HasSubstr("lane_changes"))));
  Json wrong = evaluation("rules", 7);
  wrong["collisions_by_kind"]["side_by_ego"] = "many";
  EXPECT_THROW(parse_evaluation(wrong, "x"), Failure);
  Json empty = evaluation("rules", 7);
  empty["per_episode"] = Json::array();
  EXPECT_THROW(parse_evaluation(empty, "x"), Failure);
  Json no_steps = evaluation("rules", 7);
  no_steps["per_episode"][0]["steps"] = 0;
  EXPECT_THROW(parse_evaluation(no_steps, "x"), Failure);
  EXPECT_THROW(parse_evaluation(Json::array(), "x"), Failure);
  Json still = evaluation("rules", 7);
  still["mean_speed_kph"] = 0.0;
  EXPECT_THROW(parse_evaluation(still, "x"), Failure);
  EXPECT_THAT([] { parse_evaluation(evaluation("flying", 7), "x"); },
              ThrowsMessage<Failure>(HasSubstr("flying")));
}

}  // namespace
}  // namespace corridor::cluster
