// SPDX-License-Identifier: Apache-2.0
#include "actor/driving/action.h"

#include <gtest/gtest.h>

#include "tests/actor/driving/scenes.h"

namespace corridor::driving {
namespace {

// Three changes with easy numbers, whatever the default.
const DrivingSettings kThreeChanges = [] {
  DrivingSettings settings = kSettings;
  settings.planner.speed_changes_mps = {-4.0, 0.0, 2.0};
  return settings;
}();

TEST(MopActions, HaveTheIndicesOfTheTable) {
  EXPECT_EQ(mop_action(0), (MopAction{-1, 0}));
  EXPECT_EQ(mop_action(1), (MopAction{0, 0}));
  EXPECT_EQ(mop_action(2), (MopAction{1, 0}));
  EXPECT_EQ(mop_action(8), (MopAction{1, 2}));
  for (int index = 0; index < 30; ++index) EXPECT_EQ(index_of(mop_action(index)), index);
}

TEST(StepActions, PackIntoAByteAndBack) {
  for (int packed = 0; packed < 256; ++packed) {
    const StepAction action = unpack(static_cast<std::uint8_t>(packed));
    EXPECT_EQ(pack(action.command, action.mop_action), packed);
  }
  const StepAction action = unpack(pack(Command::kRight, 8));
  EXPECT_EQ(action.command, Command::kRight);
  EXPECT_EQ(action.mop_action, 8);
}

TEST(StepActionsDeathTest, DoNotPackWhatDoesNotFit) {
  EXPECT_DEATH(pack(Command::kRight, 85), "action 85");
  EXPECT_DEATH(pack(Command::kKeep, -1), "action -1");
}

TEST(TargetFor, IsRelativeToTheEgo) {
  const Target target = target_for({1, 0}, ego_in_the_middle(), kThreeChanges);
  EXPECT_EQ(target.corridor, 8);
  EXPECT_DOUBLE_EQ(target.set_point_mps, 6.0);
  EXPECT_EQ(target_for({-1, 1}, ego_in_the_middle(), kThreeChanges).corridor, 6);
  EXPECT_DOUBLE_EQ(target_for({0, 2}, ego_in_the_middle(), kThreeChanges).set_point_mps, 12.0);
}

TEST(TargetFor, ChangesTheSetPointNotTheSpeed) {
  Ego ego = ego_in_the_middle();
  ego.set_point_mps = 4.0;
  EXPECT_DOUBLE_EQ(target_for({0, 2}, ego, kThreeChanges).set_point_mps, 6.0);
}

TEST(TargetFor, StaysWithinStandstillAndTheSpeedLimit) {
  Ego ego = ego_in_the_middle();
  ego.set_point_mps = 3.0;
  EXPECT_EQ(target_for({0, 0}, ego, kThreeChanges).set_point_mps, 0.0);
  ego.set_point_mps = 13.0;
  EXPECT_EQ(target_for({0, 2}, ego, kThreeChanges).set_point_mps, 13.89);
}

TEST(TargetFor, StaysWhereTheBodyIsOnTheRoad) {
  Ego ego = ego_in_the_middle();
  ego.d_m = 0.96;  // corridor 1; in corridor 0 the body would be 0.58 m off
  EXPECT_EQ(target_for({-1, 1}, ego, kThreeChanges).corridor, 1);
  ego.d_m = 0.1;
  EXPECT_EQ(target_for({0, 1}, ego, kThreeChanges).corridor, 1);
  ego.d_m = 9.6 - 0.96;
  EXPECT_EQ(target_for({1, 1}, ego, kThreeChanges).corridor, 13);
}

TEST(UnchangedSpeed, IsTheChangeNearestToNone) {
  DrivingSettings settings = driving_settings(RunConfig{});
  EXPECT_EQ(settings.planner.speed_changes_mps[3], 0.0);
  EXPECT_EQ(unchanged_speed(settings), 3);
  settings.planner.speed_changes_mps = {-4.0, -0.5, 2.0};
  EXPECT_EQ(unchanged_speed(settings), 1);
}

}  // namespace
}  // namespace corridor::driving
