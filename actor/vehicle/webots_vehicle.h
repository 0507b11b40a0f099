// SPDX-License-Identifier: Apache-2.0
// A car of a running Webots (R2022a and later: x ahead, y left, z up), driven by its public
// automobile API. It needs Webots' headers and libraries, and a process that Webots has for the
// car's controller, with supervisor rights, on a level ground. Tests compile it against a fake of
// those headers (tests/actor/vehicle/webots_fake); it has not been run in Webots.
#pragma once

#include <array>
#include <webots/vehicle/Car.hpp>

#include "actor/vehicle/vehicle.h"

namespace corridor::vehicle {

class WebotsVehicle : public Vehicle {
 public:
  // `car` outlives it. Throws a Failure when Webots ends the simulation, or cannot bring the car to
  // the speed that it is to be placed with.
  explicit WebotsVehicle(webots::Car& car);

  // A car that is moved stands, its wheels too: it is put back to where the world has it, run up to
  // speed, and the plane frame laid so that it is where it should be.
  void place(const VehicleState& start) override;
  void set_steering_angle(double angle_rad) override;
  void set_cruising_speed(double speed_mps) override;
  void set_brake_intensity(double share) override;
  double time_step_s() const override;
  void step() override;
  VehicleState state() const override;

 private:
  struct Pose {
    double x_m = 0.0, y_m = 0.0, yaw_rad = 0.0;
  };
  Pose pose_in_webots() const;

  webots::Car& car_;
  std::array<double, 3> home_m_;     // the car's translation and rotation when it was taken over
  std::array<double, 4> home_turn_;  // axis, angle
  Pose plane_from_;                  // in Webots, of what plane_to_ is in the plane frame
  Pose plane_to_;
  Pose before_, now_;  // in Webots, around the last step
};

}  // namespace corridor::vehicle
