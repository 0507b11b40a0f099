// SPDX-License-Identifier: Apache-2.0
// The linear single-track model (Rajamani 2012, chapter 2), to measure simulated cars against.
#pragma once

#include <algorithm>
#include <cmath>

#include "actor/vehicle/vehicle_model.h"

namespace corridor::vehicle {

class SingleTrack {
 public:
  SingleTrack(const CarModel& car, double stiffness, double speed_mps)
      : car_(car), speed_mps_(speed_mps) {
    rear_m_ = car.wheelbase_m * car.front_axle_share();
    front_m_ = car.wheelbase_m - rear_m_;
    front_npr_ = stiffness * car.mass_kg() * kGravity_mps2 * car.front_axle_share();
    rear_npr_ = stiffness * car.mass_kg() * kGravity_mps2 - front_npr_;
    const double r = car.tyre_radius_m, w = car.tyre_width_m;
    inertia_kgm2_ =
        car.inertia_z_kgm2 + car.body_mass_kg * std::pow(car.centre_of_mass_x_m - rear_m_, 2);
    for (const double axle_m : {front_m_, -rear_m_}) {
      inertia_kgm2_ += 2 * car.wheel_mass_kg * (axle_m * axle_m + car.track_m * car.track_m / 4) +
                       2 * car.wheel_mass_kg * (3 * r * r + w * w) / 12;
    }
  }

  // One short step; the steering lags its command as the car's motor does.
  void step(double command_rad, double step_s) {
    steering_rad_ +=
        step_s * std::clamp(car_.steering_gain_per_s * (command_rad - steering_rad_),
                            -car_.steering_rate_max_radps, car_.steering_rate_max_radps);
    const double front_n =
        front_npr_ * (steering_rad_ - (lateral_mps_ + front_m_ * yaw_rate_radps_) / speed_mps_);
    const double rear_n = -rear_npr_ * (lateral_mps_ - rear_m_ * yaw_rate_radps_) / speed_mps_;
    lateral_mps_ += step_s * ((front_n + rear_n) / car_.mass_kg() - speed_mps_ * yaw_rate_radps_);
    yaw_rate_radps_ += step_s * (front_m_ * front_n - rear_m_ * rear_n) / inertia_kgm2_;
  }

  double yaw_rate_radps() const { return yaw_rate_radps_; }

 private:
  CarModel car_;
  double speed_mps_;
  double front_m_ = 0.0, rear_m_ = 0.0, front_npr_ = 0.0, rear_npr_ = 0.0, inertia_kgm2_ = 0.0;
  double steering_rad_ = 0.0, lateral_mps_ = 0.0, yaw_rate_radps_ = 0.0;
};

}  // namespace corridor::vehicle
