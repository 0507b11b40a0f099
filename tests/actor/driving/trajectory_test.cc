// SPDX-License-Identifier: Apache-2.0
#include "actor/driving/trajectory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/actor/driving/scenes.h"

namespace corridor::driving {
namespace {

// What the world makes of the ego after `t_s` on a trajectory.
Ego ego_after(const Trajectory& trajectory, double t_s) {
  const TrajectoryPoint point = trajectory.at(t_s);
  return {.s_m = point.s_m,
          .d_m = point.d_m,
          .speed_mps = point.speed_mps,
          .lateral_speed_mps = point.lateral_speed_mps,
          .set_point_mps = trajectory.target().set_point_mps};
}

TEST(TrajectoryAlongTheRoad, AcceleratesToTheSetPointAndHoldsIt) {
  const Trajectory trajectory(ego_in_the_middle(), {7, 12.0}, kSettings);
  // 0.8 s at 2.5 m/s2, then 12 m/s.
  EXPECT_DOUBLE_EQ(trajectory.at(0.4).speed_mps, 11.0);
  EXPECT_DOUBLE_EQ(trajectory.at(0.4).s_m, 100.0 + 4.0 + 0.2);
  EXPECT_DOUBLE_EQ(trajectory.at(0.4).acceleration_mps2, 2.5);
  EXPECT_EQ(trajectory.at(1.0).speed_mps, 12.0);
  EXPECT_DOUBLE_EQ(trajectory.at(1.0).s_m, 100.0 + 8.8 + 2.4);
  EXPECT_EQ(trajectory.at(1.0).acceleration_mps2, 0.0);
}

TEST(TrajectoryAlongTheRoad, BrakesToTheSetPointAndHoldsIt) {
  const Trajectory trajectory(ego_in_the_middle(), {7, 4.0}, kSettings);
  EXPECT_DOUBLE_EQ(trajectory.at(0.5).speed_mps, 7.0);
  EXPECT_DOUBLE_EQ(trajectory.at(1.5).s_m, 100.0 + 7.0 + 2.0);
  EXPECT_EQ(trajectory.at(1.5).speed_mps, 4.0);
}

TEST(TrajectoryAlongTheRoad, ComesToAStandstillAndNeverGoesBackwards) {
  const Trajectory trajectory(ego_in_the_middle(), {7, 0.0}, kSettings);
  const double stop_m = 100.0 + 100.0 / 12.0;
  EXPECT_NEAR(trajectory.at(2.0).s_m, stop_m, 1e-9);
  EXPECT_NEAR(trajectory.at(1000.0).s_m, stop_m, 1e-9);
  EXPECT_EQ(trajectory.at(1000.0).speed_mps, 0.0);
}

TEST(TrajectoryAcrossTheRoad, ArrivesExactlyAtTheNextCorridorsCentreAfterOneStep) {
  const Lanes lanes(kSettings);
  for (int corridor = 1; corridor < 13; ++corridor) {
    for (const int change : {-1, 0, 1}) {
      Ego ego = ego_in_the_middle();
      ego.d_m = lanes.corridor_centre_m(corridor);
      const TrajectoryPoint end = Trajectory(ego, {corridor + change, 10.0}, kSettings).at(1.0);
      EXPECT_EQ(end.d_m, lanes.corridor_centre_m(corridor + change));
      EXPECT_EQ(end.lateral_speed_mps, 0.0);
    }
  }
}

TEST(TrajectoryAcrossTheRoad, TakesTheChangeTimeForEachCorridorOfDistance) {
  const Trajectory trajectory(ego_in_the_middle(), {10, 10.0}, kSettings);
  EXPECT_NEAR(trajectory.lateral_duration_s(), 3.0, 1e-9);
  EXPECT_NEAR(trajectory.at(1.5).d_m, 4.8 + 0.96, 1e-9) << "half-way at half-time";
  EXPECT_EQ(trajectory.at(50.0).d_m, Lanes(kSettings).corridor_centre_m(10));
}

// Position and lateral speed are given at the start, and speed is the derivative of position.
TEST(TrajectoryAcrossTheRoad, IsSmooth) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Draws draws(seed);
    Ego ego = ego_in_the_middle();
    ego.d_m = draws.uniform(0.9, 8.7);
    ego.lateral_speed_mps = draws.uniform(-1.2, 1.2);
    const int corridor =
        std::clamp(Lanes(kSettings).corridor_at(ego.d_m) + draws.below(3) - 1, 0, 14);
    const Trajectory trajectory(ego, {corridor, draws.uniform(0.0, 13.89)}, kSettings);
    EXPECT_NEAR(trajectory.at(0.0).d_m, ego.d_m, 1e-12);
    EXPECT_NEAR(trajectory.at(0.0).lateral_speed_mps, ego.lateral_speed_mps, 1e-12);
    const double dt_s = 1e-4;
    const double end_s = trajectory.lateral_duration_s() + 0.2;
    for (double t_s = 0.05; t_s < end_s; t_s += 0.05) {
      const double slope_mps =
          (trajectory.at(t_s + dt_s).d_m - trajectory.at(t_s - dt_s).d_m) / (2 * dt_s);
      ASSERT_NEAR(slope_mps, trajectory.at(t_s).lateral_speed_mps, 1e-4) << seed << " " << t_s;
      const double step_mps =
          trajectory.at(t_s + dt_s).lateral_speed_mps - trajectory.at(t_s - dt_s).lateral_speed_mps;
      ASSERT_LT(std::abs(step_mps), 50.0 * dt_s) << "a jump of the lateral speed";
    }
  }
}

// Random actions, step after step: speeds, accelerations and the road's edges are kept.
TEST(Trajectory, NeverExceedsTheLimits) {
  for (const double step_s : {1.0, 0.5, 0.2}) {
    DrivingSettings settings = kSettings;
    settings.step_s = step_s;
    Draws draws(7);
    Ego ego = ego_in_the_middle();
    for (int step = 0; step < 2000; ++step) {
      const Target target = target_for({draws.below(3) - 1, draws.below(3)}, ego, settings);
      const Trajectory trajectory(ego, target, settings);
      double speed_mps = ego.speed_mps;
      double s_m = ego.s_m;
      for (int part = 1; part <= 10; ++part) {
        const TrajectoryPoint point = trajectory.at(step_s * part / 10);
        ASSERT_GE(point.s_m, s_m);
        ASSERT_GE(point.speed_mps, 0.0);
        ASSERT_LE(point.speed_mps, 13.89);
        const double mean_mps2 = (point.speed_mps - speed_mps) / (step_s / 10);
        ASSERT_LE(mean_mps2, 2.5 + 1e-9);
        ASSERT_GE(mean_mps2, -6.0 - 1e-9);
        ASSERT_GT(point.d_m, 0.5);
        ASSERT_LT(point.d_m, 9.6 - 0.5);
        ASSERT_LT(std::abs(point.lateral_speed_mps), 2.0);
        speed_mps = point.speed_mps;
        s_m = point.s_m;
      }
      ego = ego_after(trajectory, step_s);
    }
  }
}

TEST(Trajectory, DoesNotDriftInAThousandStepsOfMovingToAndFro) {
  const Lanes lanes(kSettings);
  Ego ego = ego_in_the_middle();
  ego.speed_mps = ego.set_point_mps = 13.89;
  for (int step = 0; step < 1000; ++step) {
    const int corridor = 7 + step % 3 - 1;
    ego = ego_after({ego, {corridor, 13.89}, kSettings}, 1.0);
    if (corridor == 7) {
      ASSERT_EQ(ego.d_m, lanes.corridor_centre_m(7));
    }
    ASSERT_EQ(ego.speed_mps, 13.89);
  }
  EXPECT_NEAR(ego.s_m, 100.0 + 13890.0, 1e-6);
}

TEST(Trajectory, PlannedAnewAtEveryShortStepStillArrives) {
  for (const double step_s : {0.5, 0.2, 0.1}) {
    DrivingSettings settings = kSettings;
    settings.step_s = step_s;
    Ego ego = ego_in_the_middle();
    for (double t_s = 0.0; t_s < 2.0; t_s += step_s)
      ego = ego_after({ego, {8, 10.0}, settings}, step_s);
    EXPECT_EQ(ego.d_m, Lanes(settings).corridor_centre_m(8));
    EXPECT_EQ(ego.lateral_speed_mps, 0.0);
  }
}

TEST(Trajectory, TakesUpAMoveWhereItWasLeft) {
  DrivingSettings settings = kSettings;
  settings.step_s = 0.5;
  const Trajectory whole(ego_in_the_middle(), {8, 10.0}, settings);
  const Trajectory second_half(ego_after(whole, 0.5), {8, 10.0}, settings);
  for (const double t_s : {0.0, 0.1, 0.25, 0.4, 0.5})
    EXPECT_NEAR(second_half.at(t_s).d_m, whole.at(0.5 + t_s).d_m, 1e-9);
}

TEST(Trajectory, ReturnsGentlyFromACancelledMove) {
  DrivingSettings settings = kSettings;
  settings.step_s = 0.5;
  Ego ego = ego_after({ego_in_the_middle(), {8, 10.0}, settings}, 0.5);
  const Trajectory back(ego, {7, 10.0}, settings);
  EXPECT_EQ(back.at(10.0).d_m, Lanes(settings).corridor_centre_m(7));
  for (double t_s = 0.01; t_s < back.lateral_duration_s(); t_s += 0.01) {
    EXPECT_LT(back.at(t_s).d_m, Lanes(settings).corridor_centre_m(8));
    const double mean_mps2 =
        (back.at(t_s).lateral_speed_mps - back.at(t_s - 0.01).lateral_speed_mps) / 0.01;
    EXPECT_LT(std::abs(mean_mps2), 6.0);
  }
}

}  // namespace
}  // namespace corridor::driving
