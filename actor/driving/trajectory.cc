// SPDX-License-Identifier: Apache-2.0
#include "actor/driving/trajectory.h"

#include <algorithm>
#include <cmath>

#include "actor/driving/corridors.h"
#include "proto/base/failure.h"

namespace corridor::driving {
namespace {

// Rounding must not decide whether the ego has arrived at a step's end.
constexpr double kRounding_s = 1e-9;

}  // namespace

Trajectory::Trajectory(const Ego& ego, const Target& target, const DrivingSettings& settings)
    : target_(target), s_m_(ego.s_m), speed_mps_(ego.speed_mps) {
  CORRIDOR_CHECK(target.set_point_mps >= 0.0, "set-point {} m/s", target.set_point_mps);
  const double change_mps = target.set_point_mps - ego.speed_mps;
  acceleration_mps2_ =
      change_mps >= 0.0 ? settings.ego.acceleration_max_mps2 : -settings.ego.deceleration_max_mps2;
  ramp_s_ = change_mps / acceleration_mps2_;

  const Lanes lanes(settings);
  destination_m_ = lanes.corridor_centre_m(target.corridor);
  const double distance_m = destination_m_ - ego.d_m;
  const double corridor_change_s = settings.planner.corridor_change_s;
  // Moving away, the ego comes to rest within corridor_change_s and has that much further to go.
  const double away_mps =
      distance_m * ego.lateral_speed_mps <= 0.0 ? std::abs(ego.lateral_speed_mps) : 0.0;
  const double way_m = std::abs(distance_m) + away_mps * corridor_change_s / 2;
  const double duration_s = std::max(way_m / lanes.corridor_width_m() * corridor_change_s,
                                     std::min(settings.step_s, corridor_change_s));
  lateral_duration_s_ = duration_s;

  // d(t) = sum of lateral_[i] t^i with d, d', d'' given at 0, and d = destination, d' = d'' = 0 at
  // the end.
  const double start_mps = ego.lateral_speed_mps;
  const double start_mps2 = ego.lateral_acceleration_mps2;
  const double t2 = duration_s * duration_s;
  const double t3 = duration_s * duration_s * duration_s;
  lateral_[0] = ego.d_m;
  lateral_[1] = start_mps;
  lateral_[2] = start_mps2 / 2;
  lateral_[3] = (10.0 * distance_m - 6.0 * start_mps * duration_s - 1.5 * start_mps2 * t2) / t3;
  lateral_[4] = (-15.0 * distance_m + 8.0 * start_mps * duration_s + 1.5 * start_mps2 * t2) /
                (t3 * duration_s);
  lateral_[5] = (6.0 * distance_m - 3.0 * start_mps * duration_s - 0.5 * start_mps2 * t2) /
                (t3 * duration_s * duration_s);
}

TrajectoryPoint Trajectory::at(double t_s) const {
  CORRIDOR_CHECK(t_s >= 0.0, "{} s", t_s);
  TrajectoryPoint point;
  if (t_s < ramp_s_) {
    point.s_m = s_m_ + (speed_mps_ + acceleration_mps2_ * t_s / 2) * t_s;
    point.speed_mps = speed_mps_ + acceleration_mps2_ * t_s;
    point.acceleration_mps2 = acceleration_mps2_;
  } else {
    const double set_point_mps = target_.set_point_mps;
    point.s_m = s_m_ + (speed_mps_ + set_point_mps) / 2 * ramp_s_ + set_point_mps * (t_s - ramp_s_);
    point.speed_mps = set_point_mps;
  }
  if (t_s >= lateral_duration_s_ - kRounding_s) {
    // Exactly the centre, so that step after step does not drift.
    point.d_m = destination_m_;
    return point;
  }
  for (int power = 5; power >= 2; --power) {
    point.lateral_acceleration_mps2 =
        point.lateral_acceleration_mps2 * t_s + power * (power - 1) * lateral_[power];
  }
  for (int power = 5; power >= 0; --power) {
    point.lateral_speed_mps = point.lateral_speed_mps * t_s + point.d_m;
    point.d_m = point.d_m * t_s + lateral_[power];
  }
  return point;
}

}  // namespace corridor::driving
