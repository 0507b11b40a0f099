// SPDX-License-Identifier: Apache-2.0
// A car with dynamics of its own, driven the way that Webots' public driver API drives one
// (webots/vehicle/Driver.hpp: setSteeringAngle, setCruisingSpeed, setBrakeIntensity, step), so that
// a Webots controller can be another implementation.
#pragma once

namespace corridor::vehicle {

// In a plane frame: x along the road, y to its left. The position is that of the rear axle's
// middle, as in Webots.
struct VehicleState {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;            // > 0 to the left of x
  double speed_mps = 0.0;          // along the body
  double lateral_speed_mps = 0.0;  // of the rear axle, across the body, > 0 to the left
  double yaw_rate_radps = 0.0;
  double steering_rad = 0.0;  // of the front wheels' mean, as it is
};

// One thread owns it. Times are the vehicle's own: nothing happens between two steps.
class Vehicle {
 public:
  virtual ~Vehicle() = default;

  // Puts it there, rolling straight on at its speed: of the state only position, yaw and speed.
  virtual void place(const VehicleState& start) = 0;

  // > 0 to the left (Webots: to the right). Held until set anew, as the other two.
  virtual void set_steering_angle(double angle_rad) = 0;
  virtual void set_cruising_speed(double speed_mps) = 0;
  virtual void set_brake_intensity(double share) = 0;  // of the brakes' torque, in [0, 1]

  virtual double time_step_s() const = 0;
  virtual void step() = 0;
  virtual VehicleState state() const = 0;
};

}  // namespace corridor::vehicle
