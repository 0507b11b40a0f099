// What is measured of the ego instead of what is: normal errors (settings: [dynamics]). Pure.
#pragma once

#include <cstdint>

#include "actor/driving/scene.h"
#include "proto/settings/settings.h"

namespace corridor::world {

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
