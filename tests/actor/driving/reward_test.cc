// SPDX-License-Identifier: Apache-2.0
#include "actor/driving/reward.h"

#include <gtest/gtest.h>

#include "actor/driving/skills.h"
#include "tests/actor/driving/scenes.h"

namespace corridor::driving {
namespace {

TEST(BpReward, IsMinusFiveForAChangeToTheLeftAtAnySpeed) {
  Ego ego = ego_in_the_middle();
  ego.speed_mps = 13.0;
  EXPECT_EQ(bp_reward(0, ego, kSettings), -5.0);
  ego.speed_mps = 0.0;
  EXPECT_EQ(bp_reward(0, ego, kSettings), -5.0);
}

TEST(BpReward, IsOneAboveTheThresholdOfTheLane) {
  const double thresholds_mps[] = {10.0, 11.0, 12.0};
  for (int lane = 0; lane < 3; ++lane) {
    Ego ego{.d_m = Lanes(kSettings).lane_centre_m(lane), .speed_mps = thresholds_mps[lane]};
    EXPECT_EQ(bp_reward(lane, ego, kSettings), 0.0) << "at the threshold";
    ego.speed_mps += 0.01;
    EXPECT_EQ(bp_reward(lane, ego, kSettings), 1.0);
  }
}

TEST(BpReward, DoesNotPunishAChangeToTheRight) {
  const Ego ego{.d_m = 4.8, .speed_mps = 11.5};
  EXPECT_EQ(bp_reward(2, ego, kSettings), 1.0);
}

TEST(BpShaping, AddsUpWhatHappenedInTheStep) {
  BpRewardSettings settings;
  settings.collision_shaping = -10.0;
  settings.lane_change_shaping = -2.0;
  EXPECT_EQ(bp_shaping(false, false, settings), 0.0);
  EXPECT_EQ(bp_shaping(true, false, settings), -10.0);
  EXPECT_EQ(bp_shaping(false, true, settings), -2.0);
  EXPECT_EQ(bp_shaping(true, true, settings), -12.0);
}

// The middle lane's window, the ego in its middle at `speed_mps`, a leader `gap_m` ahead.
struct MopRewardTest : testing::Test {
  static double reward(const Scene& scene, Command command = Command::kKeep) {
    return mop_reward(scene, corridor_gaps(scene, kSettings),
                      window_for(command, scene.ego, kSettings), kSettings);
  }
  static Scene following(double speed_mps, double gap_m) {
    Ego ego = ego_in_the_middle();
    ego.speed_mps = speed_mps;
    return {ego, {{.id = 1, .s_m = 105.0 + gap_m, .d_m = 4.8, .speed_mps = speed_mps}}};
  }
};

TEST_F(MopRewardTest, IsOneInTheMiddleWithinTheToleranceOfTheTargetSpeed) {
  Scene scene{ego_in_the_middle(), {}};
  scene.ego.speed_mps = 13.89;
  EXPECT_EQ(reward(scene), 1.0);
  scene.ego.speed_mps = 12.40;
  EXPECT_EQ(reward(scene), 1.0);
  scene.ego.speed_mps = 12.38;
  EXPECT_EQ(reward(scene), 0.0);
}

TEST_F(MopRewardTest, IsZeroOffTheMiddleAtAnySpeed) {
  Scene scene{ego_in_the_middle(), {}};
  scene.ego.speed_mps = 13.89;
  scene.ego.d_m = 4.8 + 0.64;
  EXPECT_EQ(reward(scene), 0.0);
}

TEST_F(MopRewardTest, IsZeroInASwitchWindowUntilTheEgoHasMovedByOneCorridor) {
  Scene scene{ego_in_the_middle(), {}};
  scene.ego.speed_mps = 13.89;
  const Window window = window_for(Command::kLeft, scene.ego, kSettings);
  const auto gaps = corridor_gaps(scene, kSettings);
  EXPECT_EQ(mop_reward(scene, gaps, window, kSettings), 0.0);
  scene.ego.d_m += 0.64;
  EXPECT_EQ(mop_reward(scene, gaps, window, kSettings), 1.0);
}

// At 8 m/s d = 12.6 m: near it is 7.56 to 23.9 m.
TEST_F(MopRewardTest, IsOneForFollowingNearTheSafeDistance) {
  EXPECT_EQ(reward(following(8.0, 12.6)), 1.0);
  EXPECT_EQ(reward(following(8.0, 7.57)), 1.0);
  EXPECT_EQ(reward(following(8.0, 7.55)), 0.0);
  EXPECT_EQ(reward(following(8.0, 14.59)), 1.0);
  EXPECT_EQ(reward(following(8.0, 14.61)), 0.0);
}

TEST_F(MopRewardTest, IsOneAtStandstillBehindAStandingLeader) {
  EXPECT_EQ(reward(following(0.0, 3.0)), 1.0);
}

TEST_F(MopRewardTest, IsZeroForFollowingWhereACorridorIsFree) {
  Scene scene = following(8.0, 12.6);
  // From 3.2 to 4.2 m; the swath of corridor 8 begins at 4.39 m, that of corridor 7 at 3.75 m.
  scene.others[0].d_m = 3.7;
  scene.others[0].width_m = 1.0;
  EXPECT_EQ(corridor_gaps(scene, kSettings)[8].front_gap_m, 100.0);
  EXPECT_LT(corridor_gaps(scene, kSettings)[7].front_gap_m, 100.0);
  EXPECT_EQ(reward(scene), 0.0);
}

TEST_F(MopRewardTest, TakesTheSmallestGapOfTheOpenCorridors) {
  Scene scene = following(8.0, 12.6);
  scene.others.push_back({.id = 2, .s_m = 106.0, .d_m = 3.5, .speed_mps = 8.0, .width_m = 1.2});
  EXPECT_DOUBLE_EQ(corridor_gaps(scene, kSettings)[6].front_gap_m, 1.0);
  EXPECT_EQ(reward(scene), 0.0);
}

TEST_F(MopRewardTest, DoesNotMindWhatIsInClosedCorridors) {
  Scene scene = following(8.0, 12.6);
  // Beside the ego; reaches the swaths of corridors up to 5 only, the first of the lane.
  scene.others.push_back({.id = 2, .s_m = 100.0, .d_m = 2.0, .speed_mps = 8.0});
  EXPECT_EQ(corridor_gaps(scene, kSettings)[5].front_gap_m, 0.0);
  EXPECT_EQ(reward(scene), 1.0);
}

TEST_F(MopRewardTest, IsZeroForFollowingInAWindowWithoutOpenCorridors) {
  const Scene scene = following(8.0, 12.6);
  Window window = window_for(Command::kKeep, scene.ego, kSettings);
  window.open.assign(5, false);
  EXPECT_EQ(mop_reward(scene, corridor_gaps(scene, kSettings), window, kSettings), 0.0);
}

TEST_F(MopRewardTest, IsLessForAcceleratingAndBrakingWhateverElseIsEarned) {
  const double penalty = kSettings.mop_reward.acceleration_penalty;
  ASSERT_GT(penalty, 0.0);
  Scene scene{ego_in_the_middle(), {}};
  scene.ego.acceleration_mps2 = -4.0;
  EXPECT_DOUBLE_EQ(reward(scene), -4.0 * penalty);
  scene.ego.speed_mps = 13.0;
  scene.ego.acceleration_mps2 = 2.5;
  EXPECT_DOUBLE_EQ(reward(scene), 1.0 - 2.5 * penalty);
}

}  // namespace
}  // namespace corridor::driving
