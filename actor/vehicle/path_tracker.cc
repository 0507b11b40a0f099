// SPDX-License-Identifier: Apache-2.0
#include "actor/vehicle/path_tracker.h"

#include <algorithm>
#include <cmath>

#include "proto/base/failure.h"

namespace corridor::vehicle {
namespace {

// Webots' tyres do not slip: as stiff as makes no difference, and the equations stay well-behaved.
constexpr double kNoSlipStiffness = 60.0;

// Gains are for these speeds, and in between.
constexpr double kSpeedStep_mps = 1.0;
constexpr double kSpeedMin_mps = 1.0;
constexpr int kSpeeds = 60;

// What squared errors and steering cost: 0.2 m across the path count as much as 0.1 rad in heading
// and 0.007 rad of steering.
// Less than that on steering holds the path more closely and is unstable when it acts 0.2 s late.
constexpr double kErrorCost = 25.0, kHeadingCost = 100.0, kSteeringCost = 20'000.0;

// Errors across the path and in heading, each with its rate, and the steering angle, which lags.
using State = Matrix<5, 1>;
using Square = Matrix<5, 5>;
using Row = Matrix<1, 5>;

Row lqr(const Square& a, const State& b, const Square& q, double r) {
  Square p = q;
  for (int i = 0; i < 20'000; ++i) {
    const Row k = (b.transpose() * p * a) / (r + b.dot(p * b));
    const Square next = q + a.transpose() * p * (a - b * k);
    const double change = (next - p).cwiseAbs().maxCoeff() / next.cwiseAbs().maxCoeff();
    p = (next + next.transpose()) / 2;
    if (change < 1e-12) break;
  }
  return (b.transpose() * p * a) / (r + b.dot(p * b));
}

}  // namespace

PathTracker::PathTracker(const CarModel& car, const TyreModel& tyre, double period_s)
    : car_(car), period_s_(period_s) {
  CORRIDOR_CHECK(period_s > 0.0, "{} s", period_s);
  const double stiffness = tyre.stiffness > 0.0 ? tyre.stiffness : kNoSlipStiffness;
  const double mass_kg = car.mass_kg();
  to_rear_m_ = car.wheelbase_m * car.front_axle_share();
  to_front_m_ = car.wheelbase_m - to_rear_m_;
  front_stiffness_npr_ = stiffness * mass_kg * kGravity_mps2 * car.front_axle_share();
  rear_stiffness_npr_ = stiffness * mass_kg * kGravity_mps2 * (1.0 - car.front_axle_share());
  understeer_ = mass_kg / car.wheelbase_m *
                (to_rear_m_ / front_stiffness_npr_ - to_front_m_ / rear_stiffness_npr_);
  const double body_offset_m = car.centre_of_mass_x_m - to_rear_m_;
  double inertia_kgm2 = car.inertia_z_kgm2 + car.body_mass_kg * body_offset_m * body_offset_m;
  for (const double axle_m : {to_front_m_, -to_rear_m_}) {
    inertia_kgm2 += 2 * car.wheel_mass_kg * (axle_m * axle_m + car.track_m * car.track_m / 4);
  }

  const double cf = front_stiffness_npr_, cr = rear_stiffness_npr_;
  const double lf = to_front_m_, lr = to_rear_m_;
  for (int i = 0; i < kSpeeds; ++i) {
    const double v = kSpeedMin_mps + i * kSpeedStep_mps;
    // Errors across the path and in heading, and their rates (Rajamani 2.45).
    const double lag = car.steering_gain_per_s;
    Square a;
    a << 0, 1, 0, 0, 0,  //
        0, -(cf + cr) / (mass_kg * v), (cf + cr) / mass_kg, (cr * lr - cf * lf) / (mass_kg * v),
        cf / mass_kg,   //
        0, 0, 0, 1, 0,  //
        0, (cr * lr - cf * lf) / (inertia_kgm2 * v), (cf * lf - cr * lr) / inertia_kgm2,
        -(cf * lf * lf + cr * lr * lr) / (inertia_kgm2 * v), cf * lf / inertia_kgm2,  //
        0, 0, 0, 0, -lag;
    State b = State::Zero();
    b[4] = lag;
    // Discrete, the steering held for a period: (I - a h / 2)^-1 (I + a h / 2).
    const Square half = a * period_s / 2;
    const Square inverse = (Square::Identity() - half).inverse();
    Square q = Square::Zero();
    q(0, 0) = kErrorCost;
    q(2, 2) = kHeadingCost;
    gains_.push_back(
        lqr(inverse * (Square::Identity() + half), inverse * b * period_s, q, kSteeringCost));
  }
}

PathTracker::Gain PathTracker::gain_at(double speed_mps) const {
  const double at = std::clamp((speed_mps - kSpeedMin_mps) / kSpeedStep_mps, 0.0, kSpeeds - 1.0);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, gains_.size() - 1);
  const double share = at - static_cast<double>(below);
  return (1.0 - share) * gains_[below] + share * gains_[above];
}

// The steering motor's lag, and half the time for which a command is held.
double PathTracker::preview_s() const { return 1.0 / car_.steering_gain_per_s + period_s_ / 2; }

double PathTracker::steering_rad(const VehicleState& state, const PathPoint& path) const {
  const double v = std::max(state.speed_mps, 0.0);
  const double centre_y_m = state.y_m + to_rear_m_ * std::sin(state.yaw_rad);
  const double lateral_mps = state.lateral_speed_mps + to_rear_m_ * state.yaw_rate_radps;
  const double heading_rad = state.yaw_rad - path.yaw_rad;
  const double steering_per_curvature = car_.wheelbase_m + understeer_ * v * v;
  State error;
  error << (centre_y_m - path.y_m) * std::cos(path.yaw_rad),
      lateral_mps + v * std::sin(heading_rad), heading_rad,
      state.yaw_rate_radps - v * path.curvature_pm,
      state.steering_rad - path.curvature_pm * steering_per_curvature;
  const Gain gain = gain_at(v);
  // In a steady curve the car's heading differs from the path's (Rajamani 3.13).
  const double steady_rad =
      path.curvature_pm * (-to_rear_m_ + to_front_m_ * car_.mass_kg() * v * v /
                                             (rear_stiffness_npr_ * car_.wheelbase_m));
  const double forward_rad =
      path.curvature_ahead_pm * steering_per_curvature + gain[2] * steady_rad;
  return forward_rad - gain.dot(error);
}

}  // namespace corridor::vehicle
