// SPDX-License-Identifier: Apache-2.0
#include "actor/vehicle/path_tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "actor/vehicle/ode_vehicle.h"

namespace corridor::vehicle {
namespace {

constexpr double kPeriod_s = 0.05;
constexpr double kWidth_m = 3.2;

// A lane change on a quintic, from time 0 on: across the road, and its two derivatives.
struct LaneChange {
  double duration_s;

  double share(double time_s) const { return std::clamp(time_s / duration_s, 0.0, 1.0); }
  double d_m(double time_s) const {
    const double u = share(time_s);
    return kWidth_m * u * u * u * (10 - 15 * u + 6 * u * u);
  }
  double speed_mps(double time_s) const {
    const double u = share(time_s);
    return kWidth_m * 30 * u * u * (1 - u) * (1 - u) / duration_s;
  }
  double acceleration_mps2(double time_s) const {
    const double u = share(time_s);
    return kWidth_m * 60 * u * (1 - u) * (1 - 2 * u) / (duration_s * duration_s);
  }
};

// The largest lateral error of the centre of mass.
double largest_error_m(const TyreModel& tyre, double step_s, double speed_mps, double duration_s) {
  const CarModel model = bmw_x5();
  const auto owned = make_ode_vehicle(model, tyre, step_s);
  Vehicle& car = *owned;
  const PathTracker tracker(model, tyre, kPeriod_s);
  const LaneChange change{duration_s};
  const double to_centre_m = model.wheelbase_m * model.front_axle_share();
  car.place({.speed_mps = speed_mps});
  const auto period = std::lround(kPeriod_s / step_s);
  double worst_m = 0.0;
  for (auto i = -20 * period; i < std::lround((duration_s + 6.0) / step_s); ++i) {
    const double time_s = static_cast<double>(i) * step_s;
    if (i % period == 0) {
      const double ahead_s = time_s + tracker.preview_s();
      const PathPoint point{change.d_m(time_s), std::atan2(change.speed_mps(time_s), speed_mps),
                            change.acceleration_mps2(time_s) / (speed_mps * speed_mps),
                            change.acceleration_mps2(ahead_s) / (speed_mps * speed_mps)};
      car.set_steering_angle(tracker.steering_rad(car.state(), point));
    }
    car.step();
    const VehicleState state = car.state();
    const double centre_m = state.y_m + to_centre_m * std::sin(state.yaw_rad);
    worst_m = std::max(worst_m, std::abs(centre_m - change.d_m(time_s + step_s)));
  }
  return worst_m;
}

struct Tyre {
  TyreModel model;
  double step_s;
};
const Tyre kTyres[] = {
    {kRigidTyre, 0.01}, {slip_tyre(0.9), 0.002}, {slip_tyre(0.5), 0.002}, {slip_tyre(0.3), 0.002}};

TEST(PathTracker, KeepsAnEightSecondsLaneChangeWithinFiveCentimetres) {
  for (const Tyre& tyre : kTyres)
    EXPECT_LT(largest_error_m(tyre.model, tyre.step_s, 13.9, 8.0), 0.05) << tyre.model.friction;
}

TEST(PathTracker, KeepsAFourSecondsLaneChangeWithinTenCentimetresAtEverySpeed) {
  for (const Tyre& tyre : kTyres) {
    for (const double speed_mps : {10.0, 13.9, 20.0, 30.0}) {
      EXPECT_LT(largest_error_m(tyre.model, tyre.step_s, speed_mps, 4.0), 0.10)
          << tyre.model.friction << " " << speed_mps;
    }
  }
}

TEST(PathTracker, SteersStraightOnAStraightPathThatItIsOn) {
  const PathTracker tracker(bmw_x5(), slip_tyre(0.9), kPeriod_s);
  EXPECT_EQ(tracker.steering_rad({.y_m = 1.6, .speed_mps = 10.0}, {1.6}), 0.0);
  EXPECT_GT(tracker.steering_rad({.y_m = 1.0, .speed_mps = 10.0}, {1.6}), 0.0);
  EXPECT_LT(tracker.steering_rad({.y_m = 2.0, .speed_mps = 10.0}, {1.6}), 0.0);
}

}  // namespace
}  // namespace corridor::vehicle
