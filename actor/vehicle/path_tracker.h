// SPDX-License-Identifier: Apache-2.0
// Keeps a car on a path: linear-quadratic state feedback on the single-track model (Rajamani,
// Vehicle Dynamics and Control, 2012, chapters 2 and 3), with the curvature ahead fed forward.
// Pure.
#pragma once

#include <vector>

#include "actor/algebra/matrix.h"
#include "actor/vehicle/vehicle.h"
#include "actor/vehicle/vehicle_model.h"

namespace corridor::vehicle {

// The point of a path that the centre of mass is to be at now, along a straight road.
struct PathPoint {
  double y_m = 0.0;                 // across the road
  double yaw_rad = 0.0;             // the path's direction
  double curvature_pm = 0.0;        // > 0 to the left
  double curvature_ahead_pm = 0.0;  // where the car will be PathTracker::preview_s() later
};

class PathTracker {
 public:
  // Decides every `period_s`. `stiffness` is the tyres' (TyreModel); without slip a stiff tyre's.
  PathTracker(const CarModel& car, const TyreModel& tyre, double period_s);

  // How long a steering command takes to be obeyed: that much earlier curves are steered into.
  double preview_s() const;

  // The steering angle; > 0 to the left.
  double steering_rad(const VehicleState& state, const PathPoint& path) const;

 private:
  using Gain = Matrix<1, 5>;
  Gain gain_at(double speed_mps) const;

  CarModel car_;
  double period_s_;
  double to_front_m_ = 0.0, to_rear_m_ = 0.0;  // from the centre of mass to the axles
  double front_stiffness_npr_ = 0.0, rear_stiffness_npr_ = 0.0;  // of an axle
  double understeer_ = 0.0;                                      // rad s2/m
  std::vector<Gain> gains_;                                      // by speed
};

}  // namespace corridor::vehicle
