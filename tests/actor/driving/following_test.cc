#include "actor/driving/following.h"

#include <gtest/gtest.h>

#include "tests/actor/driving/scenes.h"

namespace corridor::driving {
namespace {

TEST(Following, BrakesAndClosesInOverTheSquareOfTheSpeed) {
  EXPECT_EQ(braking_way_m(6.0, 3.0), 6.0);
  EXPECT_EQ(closing_way_m(-6.0, 3.0), 6.0);
  EXPECT_EQ(closing_way_m(2.0, 3.0), 0.0) << "it draws away";
}

TEST(Following, KeepsTheDistanceThatTheRewardAsksFor) {
  EXPECT_EQ(headway_m(10.0, kSettings),
            10.0 * kSettings.mop_reward.headway_s + kSettings.mop_reward.standstill_gap_m);
}

TEST(Following, IsPromisedTheLimitOnAFreeRoadAndTheLeadersSpeedCloseBehindIt) {
  const Ego ego = ego_in_the_middle();
  const double limit_mps = kSettings.road.speed_limit_mps;
  EXPECT_EQ(promise_mps({.front_gap_m = 100.0}, ego, kSettings), limit_mps);
  EXPECT_EQ(promise_mps({.front_gap_m = 5.0, .front_rate_mps = -3.0}, ego, kSettings), 7.0);
  const double further = promise_mps({.front_gap_m = 40.0, .front_rate_mps = -3.0}, ego, kSettings);
  EXPECT_GT(further, 7.0);
  EXPECT_LT(further, limit_mps);
}

}  // namespace
}  // namespace corridor::driving
