// SPDX-License-Identifier: Apache-2.0
#include "actor/driving/prediction.h"

#include <gtest/gtest.h>

#include <vector>

#include "actor/driving/trajectory.h"
#include "proto/settings/transition.h"
#include "tests/actor/driving/scenes.h"

namespace corridor::driving {
namespace {

TEST(AfterStep, IsTheTrajectorysEndWithTheTargetsSetPoint) {
  const DrivingSettings settings = kSettings;
  const Ego ego = ego_in_the_middle();
  const MopAction action{1, 5};
  const Target target = target_for(action, ego, settings);
  const TrajectoryPoint end = Trajectory(ego, target, settings).at(settings.step_s);
  const Ego next = after_step(ego, action, settings);
  EXPECT_EQ(next, after_step(ego, target, settings));
  EXPECT_EQ(next.s_m, end.s_m);
  EXPECT_EQ(next.d_m, end.d_m);
  EXPECT_EQ(next.speed_mps, end.speed_mps);
  EXPECT_EQ(next.set_point_mps, target.set_point_mps);
}

TEST(Way, EndsWhereTheVehicleStands) {
  EXPECT_DOUBLE_EQ(way_m(10.0, 0.0, 3.0), 30.0);
  EXPECT_DOUBLE_EQ(way_m(10.0, 4.0, 1.0), 8.0);
  EXPECT_DOUBLE_EQ(way_m(10.0, 4.0, 2.5), 12.5);
  EXPECT_DOUBLE_EQ(way_m(10.0, 4.0, 60.0), 12.5);
  EXPECT_EQ(way_m(0.0, 0.0, 1.0), 0.0);
  EXPECT_EQ(way_m(0.0, 4.0, 1.0), 0.0);
}

TEST(Separation, IsTheLargerOfTheDistancesAlongAndAcross) {
  const Ego ego = ego_in_the_middle();  // 5 m by 1.8 m
  const EgoSettings size;
  EXPECT_DOUBLE_EQ(separation_m(ego, {.s_m = 112.0, .d_m = 4.8}, size), 7.0);
  EXPECT_DOUBLE_EQ(separation_m(ego, {.s_m = 92.0, .d_m = 4.8}, size), 3.0);
  EXPECT_DOUBLE_EQ(separation_m(ego, {.s_m = 100.0, .d_m = 4.8 + 3.2}, size), 3.2 - 1.8);
  EXPECT_LT(separation_m(ego, {.s_m = 102.0, .d_m = 5.5}, size), 0.0);
}

DrivingSettings settings() {
  DrivingSettings settings = kSettings;
  settings.planner.speed_changes_mps = {-4.0, 0.0, 2.0};
  settings.planner.clearance_steps = 2;
  return settings;
}

std::vector<double> clearances_m(const Scene& scene) {
  std::vector<double> out(kMopMoves * 2);
  predicted_clearances_m(scene, settings(), out);
  return out;
}

// Where the clearance of a move stands.
std::size_t at(int corridor_change, bool brakes, int step) {
  return static_cast<std::size_t>(4 * (corridor_change + 1) + (brakes ? 0 : 2) + step - 1);
}

// At 10 m/s in the middle of the middle lane (4.8 m).
Scene beside(double d_m, double lateral_speed_mps) {
  Ego ego = ego_in_the_middle();
  ego.set_point_mps = ego.speed_mps;
  return {ego,
          {{.id = 1,
            .s_m = ego.s_m,
            .d_m = d_m,
            .speed_mps = ego.speed_mps,
            .lateral_speed_mps = lateral_speed_mps}}};
}

// Stopped, at the right edge of the ego's lane, its near end 5 m ahead.
TEST(PredictedClearances, TellWhichMoveGoesAroundAnObjectAtTheLanesEdge) {
  const Scene scene{ego_in_the_middle(),
                    {{.id = 1, .s_m = 114.0, .d_m = 3.585, .length_m = 9.0, .width_m = 0.75}}};
  const std::vector<double> clearances = clearances_m(scene);
  EXPECT_LT(clearances[at(0, false, 1)], 0.0);
  EXPECT_NEAR(clearances[at(1, false, 1)], 5.44 - 3.585 - 1.275, 1e-9);
}

TEST(PredictedClearances, AreAtTheLimitOnAnEmptyRoad) {
  EXPECT_EQ(clearances_m({ego_in_the_middle(), {}}),
            std::vector<double>(kMopMoves * 2, kClearanceMax_m));
}

TEST(PredictedClearances, FallByACorridorWithEachStepTowardsAVehicleAndRiseAway) {
  // 1.2 m between the sides.
  const auto clearances = clearances_m(beside(4.8 + 3.0, 0.0));
  EXPECT_NEAR(clearances[at(0, false, 1)], 1.2, 1e-9);
  EXPECT_NEAR(clearances[at(0, false, 2)], 1.2, 1e-9);
  EXPECT_NEAR(clearances[at(+1, false, 1)], 1.2 - 0.64, 1e-9);
  EXPECT_NEAR(clearances[at(+1, false, 2)], 1.2 - 1.28, 1e-9);
  EXPECT_NEAR(clearances[at(-1, false, 1)], 1.2 + 0.64, 1e-9);
  EXPECT_EQ(clearances[at(-1, false, 2)], kClearanceMax_m);
}

TEST(PredictedClearances, FollowAVehiclesLateralSpeed) {
  const auto clearances = clearances_m(beside(4.8 + 2.4, -1.0));  // 0.6 m between the sides
  EXPECT_NEAR(clearances[at(0, false, 1)], -0.4, 1e-9);
  EXPECT_NEAR(clearances[at(-1, false, 1)], 0.6 - 1.0 + 0.64, 1e-9);
}

TEST(PredictedClearances, TellThatBrakingLetsAVehiclePass) {
  // Braking by 4 m/s within 4/6 s, the ego is 8/3 m behind after a step, 4 m/s slower; and by 4 m/s
  // again. A length of 5 m is between them after two steps.
  const auto clearances = clearances_m(beside(4.8, 0.0));
  EXPECT_LT(clearances[at(0, true, 1)], 0.0);
  EXPECT_GT(clearances[at(0, true, 2)], 0.0);
  EXPECT_LT(clearances[at(0, false, 2)], 0.0);
}

TEST(PredictedClearances, AreOfTheNearestVehicle) {
  Scene scene = beside(4.8 + 3.0, 0.0);
  scene.others.push_back(scene.others[0]);
  scene.others[1].id = 2;
  scene.others[1].d_m = 4.8 - 2.6;
  EXPECT_NEAR(clearances_m(scene)[at(0, false, 1)], 0.8, 1e-9);
}

}  // namespace
}  // namespace corridor::driving
