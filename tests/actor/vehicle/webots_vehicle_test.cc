// SPDX-License-Identifier: Apache-2.0
#include "actor/vehicle/webots_vehicle.h"

#include <gtest/gtest.h>

#include "actor/vehicle/path_tracker.h"
#include "proto/base/failure.h"
#include "tests/actor/vehicle/drive.h"

namespace corridor::vehicle {
namespace {

const VehicleState kStart{.x_m = 50.0, .y_m = 4.8, .yaw_rad = 0.01, .speed_mps = 13.9};

void expect_near(const VehicleState& a, const VehicleState& b, double within) {
  EXPECT_NEAR(a.x_m, b.x_m, within);
  EXPECT_NEAR(a.y_m, b.y_m, within);
  EXPECT_NEAR(a.yaw_rad, b.yaw_rad, within);
  EXPECT_NEAR(a.speed_mps, b.speed_mps, within);
  EXPECT_NEAR(a.lateral_speed_mps, b.lateral_speed_mps, within);
  EXPECT_NEAR(a.yaw_rate_radps, b.yaw_rate_radps, within);
  EXPECT_NEAR(a.steering_rad, b.steering_rad, within);
}

TEST(WebotsVehicle, StandsWhereItIsAtFirst) {
  webots::Car webots;
  WebotsVehicle car(webots);
  drive(car, 1.0);
  expect_near(car.state(), {}, 1e-3);
}

TEST(WebotsVehicle, IsPlacedAnywhereAtSpeed) {
  webots::Car webots;
  WebotsVehicle car(webots);
  car.place(kStart);
  expect_near(car.state(), kStart, 0.02);
  const VehicleState once = car.state();
  car.set_steering_angle(0.1);
  drive(car, 3.0);
  car.place(kStart);
  EXPECT_EQ(car.state().yaw_rate_radps, once.yaw_rate_radps);  // nothing is left of what was
  EXPECT_EQ(car.state().speed_mps, once.speed_mps);
}

// The same car behind both interfaces, in Webots' frame, signs and units and in ours.
TEST(WebotsVehicle, DrivesAsTheCarItIs) {
  webots::Car webots;
  WebotsVehicle car(webots);
  const auto same = make_ode_vehicle(bmw_x5(), kRigidTyre, 0.01);
  for (Vehicle* vehicle : {static_cast<Vehicle*>(&car), same.get()}) {
    vehicle->place(kStart);
    vehicle->set_cruising_speed(kStart.speed_mps);
    drive(*vehicle, 1.0);
    vehicle->set_steering_angle(0.02);
    vehicle->set_cruising_speed(11.0);
    drive(*vehicle, 1.0);
    vehicle->set_steering_angle(-0.01);
    drive(*vehicle, 1.0);
    vehicle->set_brake_intensity(0.3);
    drive(*vehicle, 0.5);
  }
  EXPECT_GT(same->state().y_m, kStart.y_m + 1.0);  // to the left
  EXPECT_LT(same->state().speed_mps, 10.5);
  expect_near(car.state(), same->state(), 0.05);
}

TEST(WebotsVehicle, IsKeptOnItsPathByTheTracker) {
  webots::Car webots;
  WebotsVehicle car(webots);
  const PathTracker tracker(bmw_x5(), kRigidTyre, 0.05);
  car.place({.speed_mps = 13.9});
  for (int i = 0; i < 200; ++i) {
    car.set_steering_angle(tracker.steering_rad(car.state(), {.y_m = 1.0}));
    drive(car, 0.05);
  }
  EXPECT_NEAR(car.state().y_m, 1.0, 0.01);
  EXPECT_NEAR(car.state().yaw_rad, 0.0, 1e-3);
}

TEST(WebotsVehicle, SaysThatWebotsHasEnded) {
  webots::Car webots;
  WebotsVehicle car(webots);
  webots.steps_left = 0;
  EXPECT_THROW(car.step(), Failure);
}

TEST(WebotsVehicle, SaysThatTheCarDoesNotGetToItsSpeed) {
  webots::Car webots;
  WebotsVehicle car(webots);
  webots.stuck = true;
  EXPECT_THROW(car.place(kStart), Failure);
}

}  // namespace
}  // namespace corridor::vehicle
