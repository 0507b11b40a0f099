// SPDX-License-Identifier: Apache-2.0
#include "actor/vehicle/vehicle_model.h"

#include <cmath>

namespace corridor::vehicle {

CarModel bmw_x5() {
  CarModel car;
  car.body_mass_kg = 2000.0;
  car.wheel_mass_kg = 30.0;
  car.centre_of_mass_x_m = 1.2975;
  car.centre_of_mass_z_m = 0.1;
  car.inertia_x_kgm2 = 1125.07;
  car.inertia_y_kgm2 = 4473.54;
  car.inertia_z_kgm2 = 4346.1;
  car.inertia_xz_kgm2 = 846.89;
  car.wheelbase_m = 2.995;
  car.track_m = 1.628;
  car.tyre_radius_m = 0.374;
  car.tyre_width_m = 0.25;
  car.front_overhang_m = 0.9;
  car.spring_npm = 100e3;
  car.damping_nspm = 4e3;
  car.drive_mps2 = 3.97;
  car.brake_nm = 1800.0;
  car.wheel_damping_nms = 2.0;
  car.steering_max_rad = 1.0;
  car.steering_rate_max_radps = 10.0;
  car.steering_gain_per_s = 10.0;
  return car;
}

CarModel toyota_prius() {
  CarModel car = bmw_x5();
  car.body_mass_kg = 1805.0;
  car.wheel_mass_kg = 8.0;
  car.wheelbase_m = 2.8;
  // 0 to 100 km/h in 10.7 s, not 7.
  car.drive_mps2 *= 7.0 / 10.7;
  return car;
}

LateralForce lateral_force(const TyreModel& tyre, double slip_rad) {
  const double scale = tyre.stiffness / (tyre.shape * tyre.friction);
  const double angle_rad = tyre.shape * std::atan(scale * slip_rad);
  return {tyre.friction * std::sin(angle_rad),
          tyre.stiffness * std::cos(angle_rad) / (1.0 + scale * scale * slip_rad * slip_rad)};
}

}  // namespace corridor::vehicle
