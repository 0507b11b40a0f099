// SPDX-License-Identifier: Apache-2.0
#include "actor/vehicle/ode_vehicle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "tests/actor/vehicle/drive.h"
#include "tests/actor/vehicle/single_track.h"

namespace corridor::vehicle {
namespace {

struct Kind {
  std::string name;
  TyreModel tyre;
  double step_s;
};
void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }

const Kind kRigid{"rigid", kRigidTyre, 0.01};
const Kind kDry{"dry", slip_tyre(0.9), 0.002};
const Kind kWet{"wet", slip_tyre(0.5), 0.002};
const Kind kSnow{"snow", slip_tyre(0.3), 0.002};

class OdeVehicleOf : public testing::TestWithParam<Kind> {
 protected:
  const std::unique_ptr<Vehicle> owned_ =
      make_ode_vehicle(bmw_x5(), GetParam().tyre, GetParam().step_s);
  Vehicle& car_ = *owned_;
};
INSTANTIATE_TEST_SUITE_P(, OdeVehicleOf, testing::Values(kRigid, kDry, kWet, kSnow),
                         [](const auto& kind) { return kind.param.name; });

TEST_P(OdeVehicleOf, StandsStill) {
  drive(car_, 5.0);
  const VehicleState state = car_.state();
  EXPECT_NEAR(state.x_m, 0.0, 0.01);
  EXPECT_NEAR(state.y_m, 0.0, 1e-3);
  EXPECT_NEAR(state.yaw_rad, 0.0, 1e-4);
  EXPECT_NEAR(state.speed_mps, 0.0, 1e-3);
}

TEST_P(OdeVehicleOf, KeepsItsSpeedAndItsCourse) {
  car_.place({.x_m = 50.0, .y_m = 4.8, .speed_mps = 13.9});
  drive(car_, 10.0);
  const VehicleState state = car_.state();
  EXPECT_NEAR(state.x_m, 50.0 + 139.0, 0.2);
  EXPECT_NEAR(state.y_m, 4.8, 1e-3);
  EXPECT_NEAR(state.yaw_rad, 0.0, 1e-4);
  EXPECT_NEAR(state.speed_mps, 13.9, 0.01);
}

TEST_P(OdeVehicleOf, BrakesAsHardAsItsTyresOrBrakesCan) {
  car_.place({.speed_mps = 13.9});
  drive(car_, 1.0);
  const double from_m = car_.state().x_m;
  car_.set_brake_intensity(1.0);
  drive(car_, 8.0);
  const VehicleState state = car_.state();
  EXPECT_NEAR(state.speed_mps, 0.0, 0.01);
  EXPECT_NEAR(state.yaw_rad, 0.0, 0.01);
  const double deceleration_mps2 = 13.9 * 13.9 / 2 / (state.x_m - from_m);
  const CarModel car = bmw_x5();
  const double brakes_mps2 = 4 * car.brake_nm / car.tyre_radius_m / car.mass_kg();
  const double most_mps2 = std::min(brakes_mps2, GetParam().tyre.friction * 9.81);
  EXPECT_GT(deceleration_mps2, 0.85 * most_mps2);
  EXPECT_LT(deceleration_mps2, 1.15 * most_mps2);
}

TEST_P(OdeVehicleOf, StartsAgain) {
  car_.set_cruising_speed(10.0);
  drive(car_, 20.0);
  EXPECT_NEAR(car_.state().speed_mps, 10.0, 0.05);
  EXPECT_NEAR(car_.state().y_m, 0.0, 0.01);
  car_.set_cruising_speed(0.0);
  drive(car_, 20.0);
  EXPECT_NEAR(car_.state().speed_mps, 0.0, 0.02);
}

TEST_P(OdeVehicleOf, TurnsToTheSideThatItIsSteeredTo) {
  for (const double side : {1.0, -1.0}) {
    car_.place({.speed_mps = 10.0});
    car_.set_steering_angle(0.02 * side);
    drive(car_, 2.0);
    EXPECT_GT(side * car_.state().yaw_rad, 0.05);
    EXPECT_GT(side * car_.state().y_m, 0.3);
    EXPECT_NEAR(car_.state().steering_rad, 0.02 * side, 1e-6);
  }
}

TEST_P(OdeVehicleOf, IsTheSameToTheLastBitWhateverWasBefore) {
  const auto state_after = [&](Vehicle& car) {
    car.place({.x_m = 3.0, .y_m = 1.6, .yaw_rad = 0.01, .speed_mps = 12.0});
    for (int i = 0; i < 50; ++i) {
      car.set_steering_angle(0.01 * std::sin(i));
      car.set_cruising_speed(10.0 + std::cos(i));
      drive(car, 0.05);
    }
    const VehicleState state = car.state();
    return std::array{
        state.x_m,           state.y_m, state.yaw_rad, state.speed_mps, state.lateral_speed_mps,
        state.yaw_rate_radps};
  };
  const auto first = state_after(car_);
  drive(car_, 1.7);
  EXPECT_EQ(state_after(car_), first);
  const auto other = make_ode_vehicle(bmw_x5(), GetParam().tyre, GetParam().step_s);
  EXPECT_EQ(state_after(*other), first);
}

double peak_ratio(const Kind& kind, double speed_mps, double amplitude_rad) {
  const auto owned = make_ode_vehicle(bmw_x5(), kind.tyre, kind.step_s);
  Vehicle& car = *owned;
  car.place({.speed_mps = speed_mps});
  drive(car, 2.0);
  SingleTrack reference(bmw_x5(), slip_tyre(1.0).stiffness, speed_mps);
  double peak = 0.0, reference_peak = 0.0;
  for (int i = 0; i < std::lround(8.0 / kind.step_s); ++i) {
    const double time_s = i * kind.step_s;
    const double command_rad = amplitude_rad * std::sin(2 * std::numbers::pi * 0.25 * time_s);
    car.set_steering_angle(command_rad);
    car.step();
    reference.step(command_rad, kind.step_s);
    if (time_s < 4.0) continue;
    peak = std::max(peak, std::abs(car.state().yaw_rate_radps));
    reference_peak = std::max(reference_peak, std::abs(reference.yaw_rate_radps()));
  }
  return peak / reference_peak;
}

TEST(OdeVehicle, YawsAsTheSingleTrackModel) {
  for (const Kind& kind : {kRigid, kDry}) {
    for (const double speed_mps : {13.9, 25.0}) {
      EXPECT_NEAR(peak_ratio(kind, speed_mps, 0.01), 1.0, 0.02) << kind.name << " " << speed_mps;
    }
    EXPECT_NEAR(peak_ratio(kind, 13.9, 0.03), 1.0, 0.02) << kind.name;
  }
}

TEST(OdeVehicle, SlidesOnSnow) { EXPECT_LT(peak_ratio(kSnow, 13.9, 0.06), 0.9); }

TEST(OdeVehicle, ThePriusIsAnotherCar) {
  const auto x5 = make_ode_vehicle(bmw_x5(), kRigidTyre, 0.01);
  const auto prius = make_ode_vehicle(toyota_prius(), kRigidTyre, 0.01);
  for (Vehicle* car : {x5.get(), prius.get()}) {
    car->place({.speed_mps = 5.0});
    car->set_cruising_speed(13.0);
    drive(*car, 2.0);
  }
  EXPECT_GT(x5->state().speed_mps, prius->state().speed_mps + 1.0);
}

}  // namespace
}  // namespace corridor::vehicle
