// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "webots/vehicle/Car.hpp"

namespace webots {

using corridor::vehicle::VehicleState;

namespace {

// Where the world file has the car.
constexpr double kTranslation[3] = {12.0, -7.0, 0.374};
constexpr double kRotation[4] = {0.0, 0.0, 1.0, 0.4};

}  // namespace

void Field::setSFVec3f(const double values[3]) { std::copy_n(values, 3, values_); }
void Field::setSFRotation(const double values[4]) { std::copy_n(values, 4, values_); }

Node::Node(double time_step_s)
    : car_(corridor::vehicle::make_ode_vehicle(corridor::vehicle::bmw_x5(),
                                               corridor::vehicle::kRigidTyre, time_step_s)) {
  translation_.setSFVec3f(kTranslation);
  rotation_.setSFRotation(kRotation);
  resetPhysics();
}

Field* Node::getField(const std::string& name) const {
  return name == "translation" ? &translation_ : name == "rotation" ? &rotation_ : nullptr;
}

const double* Node::getPosition() const {
  const VehicleState state = car_->state();
  position_[0] = state.x_m;
  position_[1] = state.y_m;
  position_[2] = translation_.values_[2];
  return position_;
}

const double* Node::getOrientation() const {
  const double yaw_rad = car_->state().yaw_rad;
  const double cos = std::cos(yaw_rad), sin = std::sin(yaw_rad);
  const double rows[9] = {cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0};
  std::copy_n(rows, 9, orientation_);
  return orientation_;
}

const double* Node::getVelocity() const {
  const VehicleState state = car_->state();
  const double cos = std::cos(state.yaw_rad), sin = std::sin(state.yaw_rad);
  const double across = state.lateral_speed_mps +
                        state.yaw_rate_radps * corridor::vehicle::bmw_x5().centre_of_mass_x_m;
  velocity_[0] = cos * state.speed_mps - sin * across;
  velocity_[1] = sin * state.speed_mps + cos * across;
  velocity_[5] = state.yaw_rate_radps;
  return velocity_;
}

void Node::resetPhysics() {
  car_->place({.x_m = translation_.values_[0],
               .y_m = translation_.values_[1],
               .yaw_rad = rotation_.values_[3]});
}

Driver::Driver() : node_(new Node(getBasicTimeStep() / 1000.0)) { self_ = node_.get(); }
Driver::~Driver() = default;

int Driver::step() {
  if (steps_left-- == 0) return -1;
  if (!stuck) self_->car_->step();
  return 0;
}

void Driver::setSteeringAngle(double angle) { self_->car_->set_steering_angle(-angle); }
void Driver::setCruisingSpeed(double speed) { self_->car_->set_cruising_speed(speed / 3.6); }
void Driver::setBrakeIntensity(double share) { self_->car_->set_brake_intensity(share); }

// After Ackermann, as the Car library's.
double Car::getLeftSteeringAngle() const { return -self_->car_->state().steering_rad * 1.01; }
double Car::getRightSteeringAngle() const { return -self_->car_->state().steering_rad * 0.99; }

}  // namespace webots
