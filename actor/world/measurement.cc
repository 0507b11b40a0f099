#include "actor/world/measurement.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "actor/world/ego_motion.h"
#include "proto/base/random.h"

namespace corridor::world {
namespace {

// Box and Muller's transformation of two uniform draws.
double normal(std::uint64_t seed, std::uint64_t instant, std::uint64_t quantity) {
  const auto unit = [&](std::uint64_t draw) {
    return random_unit(seed, Purpose::kMeasurement, {instant, quantity, draw});
  };
  return std::sqrt(-2.0 * std::log1p(-unit(0))) * std::cos(2.0 * std::numbers::pi * unit(1));
}

}  // namespace

MeasurementError measurement_error(const DynamicsSettings& settings, std::uint64_t episode_seed,
                                   std::uint64_t instant) {
  MeasurementError error;
  if (settings.position_noise_m > 0.0) {
    error.along_m = settings.position_noise_m * normal(episode_seed, instant, 0);
    error.across_m = settings.position_noise_m * normal(episode_seed, instant, 1);
  }
  if (settings.speed_noise_mps > 0.0) {
    error.speed_mps = settings.speed_noise_mps * normal(episode_seed, instant, 2);
  }
  return error;
}

driving::Ego measured(const driving::Ego& ego, const MeasurementError& error,
                      const RoadSettings& road, const EgoSettings& size) {
  driving::Ego result = ego;
  result.s_m += error.along_m;
  result.d_m = on_road_m(ego.d_m + error.across_m, road, size);
  result.speed_mps = std::max(0.0, ego.speed_mps + error.speed_mps);
  return result;
}

}  // namespace corridor::world
