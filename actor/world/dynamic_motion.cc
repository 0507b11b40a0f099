// SPDX-License-Identifier: Apache-2.0
#include "actor/world/dynamic_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace corridor::world {
namespace {

using vehicle::CarModel;
using vehicle::VehicleState;

// From this deceleration on the brakes are used, not the drive.
constexpr double kBraking_mps2 = 2.5;
constexpr double kSpeedGain_per_s = 4.0;

// Trajectories move over in equal times at all speeds. Below this one a car goes across as much
// more slowly as it is slower: along the same curve, on which its corners swing out by 0.13 m.
constexpr double kFreeSpeed_mps = 10.0;
double pace_across(double speed_mps) { return std::min(1.0, speed_mps / kFreeSpeed_mps); }

double brakes_mps2(const CarModel& car) {
  return 4 * car.brake_nm / car.tyre_radius_m / car.mass_kg();
}

// From the middle of the rear axle to the middle of the front bumper.
double to_bumper_m(const CarModel& car) { return car.wheelbase_m + car.front_overhang_m; }

driving::Ego as_ego(const VehicleState& state, const CarModel& car) {
  const double cos = std::cos(state.yaw_rad), sin = std::sin(state.yaw_rad);
  driving::Ego ego;
  ego.s_m = state.x_m + cos * to_bumper_m(car);
  ego.d_m = state.y_m + sin * to_bumper_m(car);
  ego.speed_mps = state.speed_mps;
  ego.lateral_speed_mps = sin * state.speed_mps + cos * state.lateral_speed_mps +
                          cos * state.yaw_rate_radps * to_bumper_m(car);
  ego.yaw_rad = state.yaw_rad;
  return ego;
}

}  // namespace

DynamicMotion::DynamicMotion(std::unique_ptr<vehicle::Vehicle> car, const CarModel& model,
                             const vehicle::TyreModel& tyre, const DynamicsSettings& dynamics,
                             const RoadSettings& road, const EgoSettings& ego)
    : car_(std::move(car)),
      model_(model),
      tracker_(model, tyre, kControlPeriod_s),
      dynamics_(dynamics),
      road_(road),
      size_(ego),
      delayed_(
          static_cast<std::size_t>(std::lround(dynamics.actuation_delay_s / kControlPeriod_s))) {}

void DynamicMotion::begin(const driving::Ego& start, std::uint64_t episode_seed) {
  seed_ = episode_seed;
  instant_ = 0;
  car_->place(
      {.x_m = start.s_m - to_bumper_m(model_), .y_m = start.d_m, .speed_mps = start.speed_mps});
  under_way_.assign(delayed_, {0.0, start.speed_mps, 0.0});
}

Motion DynamicMotion::drive(const driving::Trajectory& trajectory, double from_s, double to_s) {
  if (from_s == 0.0) across_s_ = 0.0;
  const auto periods = std::lround((to_s - from_s) / kControlPeriod_s);
  const auto steps = std::lround(kControlPeriod_s / car_->time_step_s());
  for (long period = 0; period < periods; ++period) {
    const double time_s = from_s + static_cast<double>(period) * kControlPeriod_s;
    VehicleState measured = car_->state();
    const MeasurementError error = measurement_error(dynamics_, seed_, instant_++);
    measured.x_m += error.along_m;
    measured.y_m += error.across_m;
    measured.speed_mps += error.speed_mps;
    under_way_.push_back(decide(trajectory, time_s, measured));
    const Controls now = under_way_.front();
    under_way_.erase(under_way_.begin());
    car_->set_steering_angle(now.steering_rad);
    car_->set_cruising_speed(now.speed_mps);
    car_->set_brake_intensity(now.brake);
    for (long step = 0; step < steps; ++step) car_->step();
    across_s_ += pace_across(trajectory.at(time_s).speed_mps) * kControlPeriod_s;
  }

  Motion motion;
  motion.ego = as_ego(car_->state(), model_);
  motion.ego.set_point_mps = trajectory.target().set_point_mps;
  motion.measured =
      measured(motion.ego, measurement_error(dynamics_, seed_, instant_), road_, size_);
  // Along the road trajectories begin where the car is: it is its speed that is kept.
  motion.reference = motion.ego;
  motion.reference.speed_mps = trajectory.at(to_s).speed_mps;
  // Across it they go on where the last one has got to, in its own time.
  const driving::TrajectoryPoint planned = trajectory.at(across_s_);
  motion.reference.d_m = planned.d_m;
  motion.reference.lateral_speed_mps = planned.lateral_speed_mps;
  motion.reference.lateral_acceleration_mps2 = planned.lateral_acceleration_mps2;
  return motion;
}

DynamicMotion::Controls DynamicMotion::decide(const driving::Trajectory& trajectory, double time_s,
                                              const VehicleState& measured) const {
  const driving::TrajectoryPoint now = trajectory.at(time_s);
  const driving::TrajectoryPoint soon = trajectory.at(time_s + kControlPeriod_s);
  const double pace = pace_across(now.speed_mps);
  const driving::TrajectoryPoint here = across(trajectory, 0.0, pace);
  const driving::TrajectoryPoint ahead = across(trajectory, tracker_.preview_s(), pace);
  const double speed_mps = std::max(now.speed_mps, 1.0);
  const vehicle::PathPoint path{here.d_m, std::atan2(here.lateral_speed_mps, speed_mps),
                                here.lateral_acceleration_mps2 / (speed_mps * speed_mps),
                                ahead.lateral_acceleration_mps2 / (speed_mps * speed_mps)};
  Controls controls;
  controls.steering_rad = tracker_.steering_rad(measured, path);
  controls.speed_mps = soon.speed_mps;
  const double wanted_mps2 =
      now.acceleration_mps2 + kSpeedGain_per_s * (now.speed_mps - measured.speed_mps);
  if (wanted_mps2 < -kBraking_mps2)
    controls.brake = std::min(1.0, -wanted_mps2 / brakes_mps2(model_));
  return controls;
}

driving::TrajectoryPoint DynamicMotion::across(const driving::Trajectory& trajectory,
                                               double ahead_s, double pace) const {
  driving::TrajectoryPoint point = trajectory.at(across_s_ + pace * ahead_s);
  point.lateral_speed_mps *= pace;
  point.lateral_acceleration_mps2 *= pace * pace;
  return point;
}

}  // namespace corridor::world
