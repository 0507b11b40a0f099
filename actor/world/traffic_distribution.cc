#include "actor/world/traffic_distribution.h"

#include "proto/base/random.h"

namespace corridor::world {
namespace {

// Its random number is for: with the episode seed, the counter of Purpose::kTrainingTraffic.
enum Quantity : std::uint64_t {
  kSlowShare = 0,
  kSpeedFactorMean = 1,
  kBlindRate = 2,
  kObjects = 3,
};

}  // namespace

TrafficSettings draw_traffic(const TrafficSettings& traffic,
                             const TrafficDistribution& distribution, std::uint64_t episode_seed) {
  TrafficSettings result = traffic;
  const auto draw = [&](Quantity quantity, const std::vector<double>& range, double& value) {
    if (range.empty()) return;
    const double share = random_unit(episode_seed, Purpose::kTrainingTraffic, {quantity});
    value = range[0] + share * (range[1] - range[0]);
  };
  draw(kSlowShare, distribution.slow_share, result.slow_share);
  draw(kSpeedFactorMean, distribution.speed_factor_mean, result.speed_factor_mean);
  draw(kBlindRate, distribution.blind_rate_per_s, result.blind_rate_per_s);
  draw(kObjects, distribution.objects_per_km, result.objects_per_km);
  if (!distribution.vehicles.empty()) {  // which Traffic draws from once an episode
    result.vehicles_min = distribution.vehicles[0];
    result.vehicles_max = distribution.vehicles[1];
  }
  return result;
}

}  // namespace corridor::world
