// SPDX-License-Identifier: Apache-2.0
// The part of Webots' C++ API that actor/vehicle/webots_vehicle uses, with the same names, signs
// and units (Car.hpp, Driver.hpp, Supervisor.hpp, Node.hpp, Field.hpp, which there are five files),
// over a car in ODE in place of a Webots.
#pragma once

#include <memory>
#include <string>

#include "actor/vehicle/ode_vehicle.h"

namespace webots {

class Node;

class Field {
 public:
  const double* getSFVec3f() const { return values_; }
  const double* getSFRotation() const { return values_; }
  void setSFVec3f(const double values[3]);
  void setSFRotation(const double values[4]);

 private:
  friend class Node;
  double values_[4] = {};
};

class Node {
 public:
  Field* getField(const std::string& name) const;
  const double* getPosition() const;
  const double* getOrientation() const;  // 3 x 3, row by row
  const double* getVelocity() const;     // linear, of the centre of mass, and angular
  void resetPhysics();

 private:
  friend class Driver;
  friend class Car;
  explicit Node(double time_step_s);

  const std::unique_ptr<corridor::vehicle::Vehicle> car_;
  mutable Field translation_, rotation_;
  mutable double position_[3] = {}, orientation_[9] = {}, velocity_[6] = {};
};

class Supervisor {
 public:
  Node* getSelf() const { return self_; }
  double getBasicTimeStep() const { return 10.0; }  // ms

 protected:
  Node* self_ = nullptr;
};

class Driver : public Supervisor {
 public:
  Driver();
  virtual ~Driver();
  virtual int step();                    // -1: the simulation has ended
  void setSteeringAngle(double angle);   // > 0: to the right
  void setCruisingSpeed(double speed);   // km/h
  void setBrakeIntensity(double share);  // of 1

  // Of this fake only.
  int steps_left = 1'000'000;
  bool stuck = false;  // cannot move

 private:
  std::unique_ptr<Node> node_;
};

class Car : public Driver {
 public:
  double getLeftSteeringAngle() const;
  double getRightSteeringAngle() const;
};

}  // namespace webots
