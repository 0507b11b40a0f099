// SPDX-License-Identifier: Apache-2.0
#include "actor/policy/exploration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace corridor::policy {
namespace {

DqnSettings settings_with(int hold_max) {
  DqnSettings settings;
  settings.epsilon = 1.0;
  settings.epsilon_end = 0.01;
  settings.epsilon_steps = 1000;
  settings.epsilon_ladder = 0.5;
  settings.exploration_hold_max = hold_max;
  return settings;
}

TEST(Epsilon, FallsLinearlyAndThenStays) {
  const DqnSettings settings = settings_with(1);
  EXPECT_DOUBLE_EQ(epsilon_of(settings, 0, 4, 0), 1.0);
  EXPECT_NEAR(epsilon_of(settings, 0, 4, 500), (1.0 + 0.01) / 2, 1e-12);
  EXPECT_DOUBLE_EQ(epsilon_of(settings, 0, 4, 1000), 0.01);
  EXPECT_DOUBLE_EQ(epsilon_of(settings, 0, 4, 9000), 0.01);
}

TEST(Epsilon, EndsLowerOnEachRungOfTheLadder) {
  const DqnSettings settings = settings_with(1);
  EXPECT_NEAR(epsilon_of(settings, 3, 4, 5000), std::pow(0.01, 1.5), 1e-12);
  EXPECT_GT(epsilon_of(settings, 1, 4, 5000), epsilon_of(settings, 2, 4, 5000));
}

TEST(Exploration, ExploresAsOftenAsEpsilonSaysAndUniformly) {
  Exploration exploration(settings_with(1), Phase::kMop, 9, 7, 0);
  exploration.begin_episode(3);
  std::map<int, int> counts;
  int explored = 0;
  constexpr int kSteps = 90'000;
  for (int step = 0; step < kSteps; ++step) {
    if (const auto action = exploration.action_for(static_cast<std::uint64_t>(step), 0.3)) {
      ++explored;
      ++counts[*action];
    }
  }
  // Four standard deviations.
  EXPECT_NEAR(explored, 0.3 * kSteps, 4 * std::sqrt(0.21 * kSteps));
  ASSERT_EQ(counts.size(), 9u);
  for (const auto& [action, count] : counts) {
    EXPECT_NEAR(count, explored / 9.0, 4 * std::sqrt(explored / 9.0)) << action;
  }
}

TEST(Exploration, HoldsARandomActionForAsLongAsDrawn) {
  Exploration exploration(settings_with(10), Phase::kBp, 3, 7, 0);
  exploration.begin_episode(0);
  std::map<int, int> lengths;
  for (std::uint64_t step = 0; step < 50'000;) {
    // Epsilon 1 only where nothing is held: the length of one hold shows.
    const auto action = exploration.action_for(step++, 1.0);
    ASSERT_TRUE(action);
    int length = 1;
    while (exploration.action_for(step, 0.0)) {
      ++length;
      ++step;
    }
    ++step;
    ++lengths[length];
  }
  EXPECT_EQ(lengths.size(), 10u);
  EXPECT_EQ(lengths.begin()->first, 1);
  EXPECT_EQ(lengths.rbegin()->first, 10);
}

TEST(Exploration, IsAFunctionOfItsCounters) {
  Exploration first(settings_with(4), Phase::kBp, 3, 7, 1);
  Exploration again(settings_with(4), Phase::kBp, 3, 7, 1);
  Exploration other_actor(settings_with(4), Phase::kBp, 3, 7, 2);
  first.begin_episode(5);
  for (std::uint64_t step = 0; step < 10; ++step) first.action_for(step, 1.0);
  int differences = 0;
  first.begin_episode(6);
  again.begin_episode(6);
  other_actor.begin_episode(6);
  for (std::uint64_t step = 0; step < 500; ++step) {
    const auto action = first.action_for(step, 0.5);
    EXPECT_EQ(action, again.action_for(step, 0.5));
    differences += action != other_actor.action_for(step, 0.5);
  }
  EXPECT_GT(differences, 100);
}

}  // namespace
}  // namespace corridor::policy
