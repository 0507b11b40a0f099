// SPDX-License-Identifier: Apache-2.0
// How the ego gets along its trajectories (settings: [dynamics]).
#pragma once

#include <cstdint>
#include <memory>

#include "actor/driving/scene.h"
#include "actor/driving/trajectory.h"
#include "proto/settings/settings.h"

namespace corridor::world {

// The ego in three ways, which differ only where a car has dynamics, or where measuring has errors.
struct Motion {
  driving::Ego ego;        // as it is
  driving::Ego measured;   // as planners see it
  driving::Ego reference;  // as it should be: trajectories that start there continue one another
};

// One thread owns it. Equal calls give equal bits.
class EgoMotion {
 public:
  virtual ~EgoMotion() = default;
  // Measurement errors follow from the episode's seed.
  virtual void begin(const driving::Ego& start, std::uint64_t episode_seed) = 0;
  // From `from_s` to `to_s` after the trajectory's start; each trajectory from 0 on without a gap.
  virtual Motion drive(const driving::Trajectory& trajectory, double from_s, double to_s) = 0;
};

// Of dynamics.world. The whole body stays on the road.
std::unique_ptr<EgoMotion> make_ego_motion(const DynamicsSettings& dynamics,
                                           const RoadSettings& road, const EgoSettings& ego);

// Nearest to `d_m`, with the ego's whole body on the road: SUMO loses a vehicle whose middle is off
// it.
double on_road_m(double d_m, const RoadSettings& road, const EgoSettings& size);

// What is measured of the ego instead of what is: normal errors.
struct MeasurementError {
  double along_m = 0.0;   // along the road
  double across_m = 0.0;  // across it
  double speed_mps = 0.0;
};

// Independent of each other and from instant to instant; exactly 0 where the settings say 0.
MeasurementError measurement_error(const DynamicsSettings& settings, std::uint64_t episode_seed,
                                   std::uint64_t instant);

// An ego with such an error: its speed is not negative, and its whole body on the road.
driving::Ego measured(const driving::Ego& ego, const MeasurementError& error,
                      const RoadSettings& road, const EgoSettings& size);

}  // namespace corridor::world
