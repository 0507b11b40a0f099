// SPDX-License-Identifier: Apache-2.0
#include "actor/vehicle/vehicle_model.h"

#include <gtest/gtest.h>

#include <cmath>

namespace corridor::vehicle {
namespace {

TEST(CarModels, CarryTheirWeightBetweenTheAxles) {
  for (const CarModel& car : {bmw_x5(), toyota_prius()}) {
    EXPECT_GT(car.front_axle_share(), 0.3);
    EXPECT_LT(car.front_axle_share(), 0.7);
    EXPECT_DOUBLE_EQ(car.mass_kg(), car.body_mass_kg + 4 * car.wheel_mass_kg);
  }
  // A body over the rear axle leaves the front two wheels.
  CarModel car = bmw_x5();
  car.centre_of_mass_x_m = 0.0;
  EXPECT_DOUBLE_EQ(car.front_axle_share(), 2 * car.wheel_mass_kg / car.mass_kg());
}

TEST(LateralForce, GrowsWithTheSlipAngleByTheStiffnessWhileItIsSmall) {
  for (const double friction : {0.3, 1.0}) {
    const TyreModel tyre = slip_tyre(friction);
    EXPECT_DOUBLE_EQ(lateral_force(tyre, 0.0).per_load, 0.0);
    EXPECT_DOUBLE_EQ(lateral_force(tyre, 0.0).per_rad, tyre.stiffness);
    EXPECT_NEAR(lateral_force(tyre, 1e-4).per_load, 1e-4 * tyre.stiffness, 1e-7);
  }
}

TEST(LateralForce, PeaksAtFrictionAndFallsBeyond) {
  const TyreModel tyre = slip_tyre(0.9);
  double peak = 0.0;
  for (double slip_rad = 0.0; slip_rad < 1.5; slip_rad += 1e-3) {
    peak = std::max(peak, lateral_force(tyre, slip_rad).per_load);
  }
  EXPECT_NEAR(peak, tyre.friction, 1e-6);
  EXPECT_LT(lateral_force(tyre, 1.5).per_load, 0.95 * peak);
  EXPECT_LT(lateral_force(tyre, 1.5).per_rad, 0.0);
}

TEST(LateralForce, IsOddAndHasItsSlopeAsDerivative) {
  const TyreModel tyre = slip_tyre(0.9);
  for (const double slip_rad : {-0.4, -0.02, 0.01, 0.1, 0.3}) {
    const LateralForce force = lateral_force(tyre, slip_rad);
    EXPECT_DOUBLE_EQ(lateral_force(tyre, -slip_rad).per_load, -force.per_load);
    const double step_rad = 1e-6;
    const double slope = (lateral_force(tyre, slip_rad + step_rad).per_load -
                          lateral_force(tyre, slip_rad - step_rad).per_load) /
                         (2 * step_rad);
    EXPECT_NEAR(force.per_rad, slope, 1e-5) << slip_rad;
  }
}

TEST(LateralForce, OfATyreWithoutStiffnessIsNone) {
  EXPECT_EQ(lateral_force(kRigidTyre, 0.2).per_load, 0.0);
  EXPECT_EQ(lateral_force(kRigidTyre, 0.2).per_rad, 0.0);
}

}  // namespace
}  // namespace corridor::vehicle
