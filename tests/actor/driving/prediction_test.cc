#include "actor/driving/prediction.h"

#include <gtest/gtest.h>

#include "actor/driving/trajectory.h"
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

}  // namespace
}  // namespace corridor::driving
