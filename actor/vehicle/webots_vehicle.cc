// SPDX-License-Identifier: Apache-2.0
#include "actor/vehicle/webots_vehicle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "proto/base/failure.h"
#include "proto/base/text.h"

namespace corridor::vehicle {
namespace {

// A run-up ends when the speed is so near, and has failed after so long.
constexpr double kSpeedTolerance_mps = 0.02;
constexpr double kRunUpMax_s = 60.0;

webots::Field& field(webots::Car& car, const char* name) {
  webots::Node* self = car.getSelf();
  if (self == nullptr) throw Failure("Webots: the car's robot must be a supervisor");
  webots::Field* field = self->getField(name);
  if (field == nullptr) throw Failure("Webots: the car's node has no field {}", name);
  return *field;
}

}  // namespace

WebotsVehicle::WebotsVehicle(webots::Car& car) : car_(car) {
  std::copy_n(field(car, "translation").getSFVec3f(), home_m_.size(), home_m_.begin());
  std::copy_n(field(car, "rotation").getSFRotation(), home_turn_.size(), home_turn_.begin());
  place({});
}

void WebotsVehicle::place(const VehicleState& start) {
  field(car_, "translation").setSFVec3f(home_m_.data());
  field(car_, "rotation").setSFRotation(home_turn_.data());
  car_.getSelf()->resetPhysics();
  set_steering_angle(0.0);
  set_brake_intensity(0.0);
  set_cruising_speed(start.speed_mps);
  now_ = pose_in_webots();
  const auto steps_max = std::lround(kRunUpMax_s / time_step_s());
  long steps = 0;
  do {
    if (steps++ == steps_max) {
      throw Failure("Webots: the car does {:.1f} m/s, not {:.1f}, after {} s", state().speed_mps,
                    start.speed_mps, kRunUpMax_s);
    }
    step();
  } while (std::abs(state().speed_mps - start.speed_mps) > kSpeedTolerance_mps);
  plane_from_ = now_;
  plane_to_ = {start.x_m, start.y_m, start.yaw_rad};
}

void WebotsVehicle::set_steering_angle(double angle_rad) { car_.setSteeringAngle(-angle_rad); }

void WebotsVehicle::set_cruising_speed(double speed_mps) {
  car_.setCruisingSpeed(speed_mps * kKphPerMps);
}

void WebotsVehicle::set_brake_intensity(double share) {
  car_.setBrakeIntensity(std::clamp(share, 0.0, 1.0));
}

double WebotsVehicle::time_step_s() const { return car_.getBasicTimeStep() / 1000.0; }

void WebotsVehicle::step() {
  before_ = now_;
  if (car_.step() == -1) throw Failure("Webots has ended the simulation");
  now_ = pose_in_webots();
}

// Speeds are those of the node's origin, the rear axle's middle, over the last step: Webots' own
// are of the centre of mass.
VehicleState WebotsVehicle::state() const {
  const double turn_rad = plane_to_.yaw_rad - plane_from_.yaw_rad;
  const double turn_cos = std::cos(turn_rad), turn_sin = std::sin(turn_rad);
  const double away_x_m = now_.x_m - plane_from_.x_m, away_y_m = now_.y_m - plane_from_.y_m;
  const double cos = std::cos(now_.yaw_rad), sin = std::sin(now_.yaw_rad);
  const double moved_x_m = now_.x_m - before_.x_m, moved_y_m = now_.y_m - before_.y_m;

  VehicleState state;
  state.x_m = plane_to_.x_m + turn_cos * away_x_m - turn_sin * away_y_m;
  state.y_m = plane_to_.y_m + turn_sin * away_x_m + turn_cos * away_y_m;
  state.yaw_rad = std::remainder(now_.yaw_rad + turn_rad, 2 * std::numbers::pi);
  state.speed_mps = (cos * moved_x_m + sin * moved_y_m) / time_step_s();
  state.lateral_speed_mps = (-sin * moved_x_m + cos * moved_y_m) / time_step_s();
  state.yaw_rate_radps = car_.getSelf()->getVelocity()[5];
  state.steering_rad = -(car_.getLeftSteeringAngle() + car_.getRightSteeringAngle()) / 2;
  return state;
}

WebotsVehicle::Pose WebotsVehicle::pose_in_webots() const {
  const webots::Node* self = car_.getSelf();
  const double* position_m = self->getPosition();
  const double x_m = position_m[0], y_m = position_m[1];
  const double* rotation = self->getOrientation();  // 3 x 3, row by row
  return {x_m, y_m, std::atan2(rotation[3], rotation[0])};
}

}  // namespace corridor::vehicle
