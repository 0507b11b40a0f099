// SPDX-License-Identifier: Apache-2.0
#include "actor/world/ego_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

namespace corridor::world {
namespace {

using driving::Ego;
using driving::Target;
using driving::Trajectory;

constexpr double kLaneMiddle_m = 4.8;
constexpr int kMiddleCorridor = 7;  // of the three lanes' fifteen

RunConfig config_of(const DynamicsSettings& dynamics) {
  RunConfig config;
  config.simulation.step_s = 0.2;
  config.dynamics = dynamics;
  return config;
}

Ego cruising(double speed_mps) {
  Ego ego;
  ego.s_m = 100.0;
  ego.d_m = kLaneMiddle_m;
  ego.speed_mps = ego.set_point_mps = speed_mps;
  return ego;
}

// Planner steps of 0.2 s, each towards a target, trajectories continuing one another.
class Drive {
 public:
  Drive(const RunConfig& config, const Ego& start, std::uint64_t seed = 1)
      : config_(config),
        motion_(make_ego_motion(config.dynamics, config.road, config.ego)),
        now_{start, start, start} {
    motion_->begin(start, seed);
  }
  void to(const Target& target, int steps = 1) {
    for (int i = 0; i < steps; ++i) {
      const Trajectory trajectory(now_.reference, target, driving_settings(config_));
      now_ = motion_->drive(trajectory, 0.0, config_.simulation.step_s);
      egos.push_back(now_.ego);
      measured.push_back(now_.measured);
      references.push_back(now_.reference);
    }
  }
  // Five corridors to the left, one a second, as the planners ask; then straight on.
  void change_lane(double speed_mps) {
    for (int corridor = kMiddleCorridor + 1; corridor <= kMiddleCorridor + 5; ++corridor)
      to({corridor, speed_mps}, 5);
    to({kMiddleCorridor + 5, speed_mps}, 20);
  }

  std::vector<Ego> egos, measured, references;

 private:
  RunConfig config_;
  std::unique_ptr<EgoMotion> motion_;
  Motion now_;
};

std::vector<DynamicsSettings> dynamic_worlds() {
  return {{.world = WorldKind::kRigid},
          {.world = WorldKind::kSlip, .friction = 0.9},
          {.world = WorldKind::kSlip, .friction = 0.5},
          {.world = WorldKind::kSlip, .friction = 0.3},
          {.world = WorldKind::kSlip, .car = Car::kToyotaPrius}};
}

TEST(EgoMotion, AKinematicEgoIsWhereItShouldBe) {
  Drive drive(config_of({}), cruising(10.0));
  drive.change_lane(10.0);
  EXPECT_EQ(drive.egos, drive.references);
  EXPECT_EQ(drive.egos, drive.measured);
  EXPECT_NEAR(drive.egos.back().d_m, 8.0, 1e-9);
}

TEST(EgoMotion, ACarWithDynamicsKeepsToTheLaneChangesThatPlannersAskFor) {
  for (const DynamicsSettings& world : dynamic_worlds()) {
    Drive drive(config_of(world), cruising(12.0));
    drive.change_lane(12.0);
    double worst_m = 0.0;
    for (std::size_t i = 0; i < drive.egos.size(); ++i) {
      // The front bumper's middle swings out by the yaw.
      worst_m = std::max(worst_m, std::abs(drive.egos[i].d_m - drive.references[i].d_m));
    }
    EXPECT_LT(worst_m, 0.35) << name_of(world.world) << " " << world.friction;
    EXPECT_NEAR(drive.egos.back().d_m, 8.0, 0.01) << name_of(world.world) << " " << world.friction;
    EXPECT_NEAR(drive.egos.back().speed_mps, 12.0, 0.05)
        << name_of(world.world) << " " << world.friction;
    EXPECT_NEAR(drive.egos.back().yaw_rad, 0.0, 1e-3)
        << name_of(world.world) << " " << world.friction;
  }
}

TEST(EgoMotion, ACarSwingsOutLittleAtAnySpeed) {
  for (const DynamicsSettings& world : dynamic_worlds()) {
    for (const double speed_mps : {2.0, 4.0, 6.0, 9.0, 13.0}) {
      Drive drive(config_of(world), cruising(speed_mps));
      // To the next corridor, 0.64 m away, in a second, or in longer where it is slow.
      drive.to({kMiddleCorridor + 1, speed_mps}, 5 + static_cast<int>(50 / speed_mps));
      double furthest_m = 0.0, yaw_rad = 0.0;
      for (const Ego& ego : drive.egos) {
        furthest_m = std::max(furthest_m, ego.d_m);
        yaw_rad = std::max(yaw_rad, std::abs(ego.yaw_rad));
      }
      EXPECT_LT(furthest_m, kLaneMiddle_m + 0.64 + 0.16)
          << name_of(world.world) << " " << speed_mps;
      EXPECT_LT(yaw_rad, 0.12) << name_of(world.world) << " " << speed_mps;
      drive.to({kMiddleCorridor + 1, speed_mps}, static_cast<int>(100 / speed_mps));
      EXPECT_NEAR(drive.egos.back().d_m, kLaneMiddle_m + 0.64, 0.05) << speed_mps;
    }
  }
}

TEST(EgoMotion, ACarWithDynamicsBrakesToAStandAndStartsAgain) {
  for (const DynamicsSettings& world : dynamic_worlds()) {
    Drive drive(config_of(world), cruising(13.0));
    drive.to({kMiddleCorridor, 0.0}, 60);
    EXPECT_NEAR(drive.egos.back().speed_mps, 0.0, 0.02)
        << name_of(world.world) << " " << world.friction;
    const double stand_m = drive.egos.back().s_m;
    drive.to({kMiddleCorridor, 0.0}, 50);
    EXPECT_NEAR(drive.egos.back().s_m, stand_m, 0.1)
        << name_of(world.world) << " " << world.friction;
    drive.to({kMiddleCorridor, 8.0}, 60);
    EXPECT_NEAR(drive.egos.back().speed_mps, 8.0, 0.1)
        << name_of(world.world) << " " << world.friction;
    EXPECT_NEAR(drive.egos.back().d_m, kLaneMiddle_m, 0.02) << name_of(world.world);
  }
}

TEST(EgoMotion, EqualDrivesAreEqualBitForBitWhateverWasDrivenBefore) {
  for (DynamicsSettings world : dynamic_worlds()) {
    world.position_noise_m = 0.1;
    world.actuation_delay_s = 0.1;
    Drive first(config_of(world), cruising(12.0));
    Drive other(config_of(world), cruising(9.0), 2);
    other.change_lane(7.0);
    first.change_lane(12.0);
    Drive second(config_of(world), cruising(12.0));
    second.change_lane(12.0);
    EXPECT_EQ(first.egos, second.egos) << name_of(world.world);
  }
}

TEST(EgoMotion, TrajectoriesContinueOneAnotherWhenTheTargetChanges) {
  RunConfig config = config_of({.world = WorldKind::kRigid});
  Drive drive(config, cruising(12.0));
  // There, back again, and there, before it has arrived.
  for (const int corridor : {8, 9, 9, 8, 7, 8, 9, 10, 10, 9}) drive.to({corridor, 12.0}, 2);
  double largest_mps2 = 0.0;
  for (std::size_t i = 1; i < drive.references.size(); ++i) {
    const Ego& before = drive.references[i - 1];
    const Ego& after = drive.references[i];
    // Within the integral of the two ends' accelerations, and so of the speeds.
    EXPECT_NEAR(after.d_m - before.d_m,
                (before.lateral_speed_mps + after.lateral_speed_mps) / 2 * 0.2, 0.03);
    largest_mps2 = std::max(largest_mps2, std::abs(after.lateral_acceleration_mps2));
  }
  EXPECT_LT(largest_mps2, 6.0);
}

TEST(EgoMotion, MeasuresWithErrorsOfTheSizeSet) {
  DynamicsSettings noisy{.position_noise_m = 0.3, .speed_noise_mps = 0.5};
  Drive drive(config_of(noisy), cruising(12.0));
  drive.to({kMiddleCorridor, 12.0}, 2000);
  double along = 0.0, across = 0.0, speed = 0.0;
  for (std::size_t i = 0; i < drive.egos.size(); ++i) {
    along += std::pow(drive.measured[i].s_m - drive.egos[i].s_m, 2);
    across += std::pow(drive.measured[i].d_m - drive.egos[i].d_m, 2);
    speed += std::pow(drive.measured[i].speed_mps - drive.egos[i].speed_mps, 2);
  }
  EXPECT_NEAR(std::sqrt(along / 2000), 0.3, 0.02);
  EXPECT_NEAR(std::sqrt(across / 2000), 0.3, 0.02);
  EXPECT_NEAR(std::sqrt(speed / 2000), 0.5, 0.03);
  EXPECT_EQ(drive.egos.back().d_m, kLaneMiddle_m);
}

TEST(EgoMotion, ADelayMakesTheCarLag) {
  const auto after_a_second = [](double delay_s) {
    Drive drive(config_of({.world = WorldKind::kRigid, .actuation_delay_s = delay_s}),
                cruising(12.0));
    drive.to({kMiddleCorridor + 1, 12.0}, 3);
    return drive.egos.back().d_m;
  };
  EXPECT_LT(after_a_second(0.1), after_a_second(0.0));
  EXPECT_LT(after_a_second(0.2), after_a_second(0.1));
}

TEST(EgoMotion, KeepsItsBodyOnTheRoad) {
  const RoadSettings road;
  const EgoSettings size;
  EXPECT_EQ(on_road_m(-1.0, road, size), size.width_m / 2);
  EXPECT_EQ(on_road_m(4.0, road, size), 4.0);
  EXPECT_DOUBLE_EQ(on_road_m(20.0, road, size), 9.6 - size.width_m / 2);
}

}  // namespace
}  // namespace corridor::world
