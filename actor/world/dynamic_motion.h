// SPDX-License-Identifier: Apache-2.0
// The ego as a car with dynamics of its own: trajectory -> path and speed controller -> vehicle
// (the lower part of paper figure 2).
#pragma once

#include <memory>
#include <vector>

#include "actor/vehicle/path_tracker.h"
#include "actor/vehicle/vehicle.h"
#include "actor/world/ego_motion.h"

namespace corridor::world {

class DynamicMotion : public EgoMotion {
 public:
  // The vehicle's centre of mass follows the trajectories across the road, a slow one's more slowly
  // than they ask; along it their speed is kept. The controller decides every kControlPeriod_s.
  DynamicMotion(std::unique_ptr<vehicle::Vehicle> car, const vehicle::CarModel& model,
                const vehicle::TyreModel& tyre, const DynamicsSettings& dynamics,
                const RoadSettings& road, const EgoSettings& ego);

  void begin(const driving::Ego& start, std::uint64_t episode_seed) override;
  Motion drive(const driving::Trajectory& trajectory, double from_s, double to_s) override;

 private:
  struct Controls {
    double steering_rad = 0.0;
    double speed_mps = 0.0;
    double brake = 0.0;
  };
  Controls decide(const driving::Trajectory& trajectory, double time_s,
                  const vehicle::VehicleState& measured) const;
  // Where across the road the car should be.
  driving::TrajectoryPoint across(const driving::Trajectory& trajectory, double ahead_s,
                                  double pace) const;

  std::unique_ptr<vehicle::Vehicle> car_;
  vehicle::CarModel model_;
  vehicle::PathTracker tracker_;
  DynamicsSettings dynamics_;
  RoadSettings road_;
  EgoSettings size_;
  std::uint64_t seed_ = 0;
  std::uint64_t instant_ = 0;        // of the controller's
  double across_s_ = 0.0;            // of the present trajectory: where its way across has got to
  std::size_t delayed_;              // periods between a decision and its effect
  std::vector<Controls> under_way_;  // decided, not yet in effect; the oldest first
};

}  // namespace corridor::world
