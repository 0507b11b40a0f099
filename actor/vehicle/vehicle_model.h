// SPDX-License-Identifier: Apache-2.0
// The cars and tyres that are simulated, as numbers with their sources.
#pragma once

namespace corridor::vehicle {

inline constexpr double kGravity_mps2 = 9.81;

// A car with four wheels, front driven and front steered. Positions from the middle of the rear
// axle: x ahead, z up.
struct CarModel {
  double body_mass_kg = 0.0;
  double wheel_mass_kg = 0.0;
  double centre_of_mass_x_m = 0.0;
  double centre_of_mass_z_m = 0.0;
  double inertia_x_kgm2 = 0.0, inertia_y_kgm2 = 0.0, inertia_z_kgm2 = 0.0, inertia_xz_kgm2 = 0.0;
  double wheelbase_m = 0.0;
  double track_m = 0.0;
  double tyre_radius_m = 0.0;
  double tyre_width_m = 0.0;
  double front_overhang_m = 0.0;  // from the front axle to the bumper
  double spring_npm = 0.0;        // of each wheel's suspension
  double damping_nspm = 0.0;
  double drive_mps2 = 0.0;  // the most that its cruise control accelerates or brakes by
  double brake_nm = 0.0;    // of each wheel
  double wheel_damping_nms = 0.0;
  double steering_max_rad = 0.0;
  double steering_rate_max_radps = 0.0;
  double steering_gain_per_s = 0.0;  // the steering motor turns by the error times this

  double mass_kg() const { return body_mass_kg + 4 * wheel_mass_kg; }
  double front_axle_share() const {  // of the weight
    return (body_mass_kg * centre_of_mass_x_m / wheelbase_m + 2 * wheel_mass_kg) / mass_kg();
  }
};

// BmwX5.proto, BmwX5Wheel.proto, Car.proto, RotationalMotor.wrl and driver.c of Webots.
CarModel bmw_x5();
// ToyotaPrius.proto; what it does not say is as of the X5.
CarModel toyota_prius();

// A tyre's forces, as shares of its load.
struct TyreModel {
  double friction = 1.0;  // Coulomb's: the most, in either direction
  // Of longitudinal force and slip, and of lateral force and slip angle while both are small; 0: no
  // slip but when friction gives way, as in Webots' highway worlds.
  double stiffness = 0.0;
  // Pacejka's C of the lateral force, which grows to friction and falls again beyond.
  double shape = 1.0;
  double softness_cfm = 1e-5;  // of the contact
};
// Rigid, as in highway.wbt of Webots.
inline constexpr TyreModel kRigidTyre{.friction = 8.0};
// p_ky1 and p_cy1 of CommonRoad's multibody model (Althoff et al. 2017, vehicle models), there with
// a friction of 1.0489. Its stiffness does not depend on friction.
inline constexpr TyreModel slip_tyre(double friction) { return {friction, 21.92, 1.3507}; }

// Lateral force and its derivative by the slip angle (Pacejka's magic formula without shifts and
// curvature). A tyre without stiffness has none.
struct LateralForce {
  double per_load = 0.0;
  double per_rad = 0.0;
};
LateralForce lateral_force(const TyreModel& tyre, double slip_rad);

}  // namespace corridor::vehicle
