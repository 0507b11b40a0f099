// SPDX-License-Identifier: Apache-2.0
#include "cluster/results/results.h"

#include <gtest/gtest.h>

#include <cmath>

#include "proto/base/random.h"
#include "proto/settings/planner_pairs.h"

namespace corridor::cluster {
namespace {

// Episodes of 1000 and 500 steps at 12.5 m/s, 30 lane changes, 15 hard brakes and 6 bypasses in
// all.
EvaluationRecord result(const std::string& planner, std::uint64_t seed, double reward_per_1000,
                        std::int64_t collisions = 3) {
  EvaluationRecord result;
  result.planner = planner;
  result.seed = seed;
  result.steps = 1500;
  result.episodes = 2;
  result.collisions = collisions;
  result.collisions_by_kind = {collisions, 0, 0, 0, 0};
  result.lane_changes = 30;
  result.mean_speed_kph = 45.0;
  result.distance_km = 18.75;
  result.per_episode = {{1000, reward_per_1000, 0.0, 0, 20, 10, 12500.0, {250, 750}, 4},
                        {500, 0.5 * reward_per_1000, 0.0, 1, 10, 5, 6250.0, {125, 375}, 2}};
  return result;
}

double random_reward(std::uint64_t i) { return 500.0 + random_unit(3, Purpose::kTraffic, {i}); }

TEST(Arms, ComeInTheOrderOfTheTableWhateverTheirOrderBefore) {
  std::vector<SeedResult> results;
  for (const PlannerPair& pair : kPlannerPairs) {
    results.insert(results.begin(), {1, result(pair.name, 1002, 500)});
  }
  std::string order;
  for (const Arm& arm : arms_of(results)) order += arm.planner + " ";
  EXPECT_TRUE(
      order.starts_with("hierarchical rules rules+mop bp+rules sumo hierarchical+shield "
                        "rules+shield rules+mop+shield left+rules left+mop keep+mop "))
      << order;
}

TEST(Arms, OfOneTrainingSeedAreSumsOverAllEpisodes) {
  const Arm arm = arms_of(
      {{1, result("hierarchical", 1002, 600)}, {1, result("hierarchical", 1003, 300, 5)}})[0];
  EXPECT_EQ(arm.training_seeds, 1u);
  EXPECT_EQ(arm.evaluation_seeds, 2u);
  EXPECT_EQ(arm.steps, 3000);
  EXPECT_DOUBLE_EQ(arm.distance_km, 37.5);
  EXPECT_DOUBLE_EQ(arm[Quantity::kBpReward].value, 450.0);
  EXPECT_LT(arm[Quantity::kBpReward].interval.low, 450.0);
  EXPECT_GT(arm[Quantity::kBpReward].interval.high, 450.0);
  EXPECT_DOUBLE_EQ(arm[Quantity::kLaneChanges].value, 20.0);
  EXPECT_DOUBLE_EQ(arm[Quantity::kLaneChangesPerKm].value, 60 / 37.5);
  EXPECT_DOUBLE_EQ(arm[Quantity::kBypassesPerKm].value, 12 / 37.5);
  EXPECT_DOUBLE_EQ(arm[Quantity::kSpeed].value, 45.0);
  EXPECT_NEAR(arm[Quantity::kSpeed].interval.low, 45.0, 1e-9);
  EXPECT_DOUBLE_EQ(arm[Quantity::kHardBrakes].value, 10.0);
  EXPECT_EQ(arm.lane_shares, (std::vector{0.25, 0.75}));
}

TEST(Arms, CountCollisionsOfAllSeedsTogetherWithExactIntervals) {
  const Arm arm = arms_of(
      {{1, result("hierarchical", 1002, 600, 3)}, {2, result("hierarchical", 1002, 600, 7)}})[0];
  EXPECT_EQ(arm.collisions, 10);
  const Interval exact = poisson_interval(10);
  for (const auto& [quantity, exposure] :
       {std::pair(Quantity::kCollisions, 3.0), std::pair(Quantity::kRearEnded, 3.0),
        std::pair(Quantity::kCollisionsPerKm, 37.5)}) {
    EXPECT_DOUBLE_EQ(arm[quantity].value, 10 / exposure);
    EXPECT_DOUBLE_EQ(arm[quantity].interval.low, exact.low / exposure);
    EXPECT_DOUBLE_EQ(arm[quantity].interval.high, exact.high / exposure);
  }
  EXPECT_EQ(arm[Quantity::kSideByEgo].value, 0.0);
  EXPECT_NEAR(arm[Quantity::kSideByEgo].interval.high, 3.689 / 3.0, 1e-3);
}

TEST(Arms, OfSeveralTrainingSeedsAreInterquartileMeansBootstrappedOverThem) {
  std::vector<SeedResult> results;
  std::vector<double> of_seeds;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const double reward = random_reward(seed) + (seed == 5 ? 1000.0 : 0.0);
    results.push_back({seed, result("hierarchical", 1002, reward)});
    results.push_back({seed, result("hierarchical", 1003, reward + 2.0)});
    of_seeds.push_back(reward + 1.0);
  }
  const Arm arm = arms_of(results)[0];
  EXPECT_EQ(arm.training_seeds, 5u);
  EXPECT_EQ(arm.evaluation_seeds, 2u);
  const Estimate& reward = arm[Quantity::kBpReward];
  EXPECT_NEAR(reward.value, interquartile_mean(of_seeds), 1e-9);
  const Interval interval =
      percentile_interval(bootstrap_interquartile_means(of_seeds, kBootstrapSeed));
  EXPECT_NEAR(reward.interval.low, interval.low, 1e-9);
  EXPECT_NEAR(reward.interval.high, interval.high, 1e-9);
}

TEST(Arms, InWhichNothingIsLearnedCountOnceForAllTrainingSeeds) {
  std::vector<SeedResult> once, five_times;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    five_times.push_back({seed, result("rules", 1002, 400)});
    five_times.push_back({seed, result("rules", 1003, 500)});
  }
  once.assign(five_times.begin(), five_times.begin() + 2);
  const Arm arm = arms_of(five_times)[0], expected = arms_of(once)[0];
  EXPECT_EQ(arm.training_seeds, 0u);
  EXPECT_EQ(arm.collisions, 6);
  EXPECT_EQ(arm.steps, 3000);
  EXPECT_EQ(arm[Quantity::kBpReward].interval, expected[Quantity::kBpReward].interval);

  EvaluationRecord longer = result("rules", 1002, 700);
  longer.steps = 40'000;
  EXPECT_EQ(arms_of({once[0], {2, longer}})[0].steps, 40'000) << "of one seed the longest";
}

TEST(Ratios, AreThoseOfTheEstimatesWithTheIntervalsOfBoth) {
  const std::vector<Arm> arms = arms_of({{1, result("hierarchical", 1002, 600, 20)},
                                         {1, result("rules", 1002, 500, 40)},
                                         {1, result("sumo", 1002, 400, 10)}});
  const Ratios& ratios = *arms[0].to_rules;
  EXPECT_DOUBLE_EQ(ratios[0]->value, 1.2);
  EXPECT_DOUBLE_EQ(ratios[1]->value, 0.5);
  const Interval exact = poisson_ratio_interval(20, 1500, 40, 1500);
  EXPECT_EQ(ratios[1]->interval, exact);
  EXPECT_DOUBLE_EQ(arms[0].to_sumo->at(0)->value, 1.5);
  EXPECT_DOUBLE_EQ(arms[2].to_rules->at(0)->value, 0.8);
  EXPECT_FALSE(arms[1].to_rules) << "to itself";
  EXPECT_TRUE(arms[1].to_sumo);
}

TEST(Ratios, AreWiderThanEitherSideAlone) {
  std::vector<SeedResult> results;
  EvaluationRecord noisy = result("hierarchical", 1002, 500);
  EvaluationRecord rules = result("rules", 1002, 500);
  noisy.per_episode.clear();
  rules.per_episode.clear();
  for (std::uint64_t i = 0; i < 50; ++i) {
    const auto episode = [&](std::uint64_t purpose) {
      return EpisodeRecord{
          1000, 1000 * random_unit(purpose, Purpose::kTraffic, {i}), 0.0, 0, 1, 1, 12500.0, {1000}};
    };
    noisy.per_episode.push_back(episode(1));
    rules.per_episode.push_back(episode(2));
  }
  const std::vector<Arm> arms = arms_of({{1, noisy}, {1, rules}});
  const auto relative_width = [](const Estimate& estimate) {
    return (estimate.interval.high - estimate.interval.low) / estimate.value;
  };
  const double own = relative_width(arms[0][Quantity::kBpReward]);
  const double other = relative_width(arms[1][Quantity::kBpReward]);
  // Independent: the squares add.
  EXPECT_NEAR(relative_width(*arms[0].to_rules->at(0)), std::hypot(own, other), 0.1 * own);
}

TEST(Ratios, AreNothingWhereTheBaselineHasNone) {
  EvaluationRecord rules = result("rules", 1002, -5, 0);
  const std::vector<Arm> arms = arms_of({{1, result("hierarchical", 1002, 600)}, {1, rules}});
  EXPECT_FALSE(arms[0].to_rules->at(0));
  EXPECT_FALSE(arms[0].to_rules->at(1));
  EXPECT_TRUE(arms[0].to_rules->at(2));
  EXPECT_FALSE(arms[0].to_sumo);
}

TEST(Arms, ThatStoodStillHaveZerosAndNotWhatDividesByThem) {
  EvaluationRecord still = result("keep+mop", 1002, 0, 0);
  still.distance_km = still.mean_speed_kph = 0.0;
  for (EpisodeRecord& episode : still.per_episode) episode.distance_m = 0.0;
  const Arm arm = arms_of({{1, still}})[0];
  EXPECT_EQ(arm[Quantity::kSpeed].value, 0.0);
  EXPECT_EQ(arm[Quantity::kLaneChangesPerKm].interval, (Interval{0.0, 0.0}));
  EXPECT_EQ(arm[Quantity::kCollisionsPerKm].value, 0.0);
}

}  // namespace
}  // namespace corridor::cluster
