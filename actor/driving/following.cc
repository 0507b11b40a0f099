#include "actor/driving/following.h"

#include <algorithm>

namespace corridor::driving {
namespace {

// A lane's worth is the speed that brings the ego up to its leader in this time.
constexpr double kHorizon_s = 12.0;

}  // namespace

double braking_way_m(double speed_mps, double braking_mps2) {
  return speed_mps * speed_mps / (2 * braking_mps2);
}

double closing_way_m(double rate_mps, double braking_mps2) {
  return braking_way_m(std::max(0.0, -rate_mps), braking_mps2);
}

double headway_m(double speed_mps, const DrivingSettings& settings) {
  return settings.mop_reward.headway_s * speed_mps + settings.mop_reward.standstill_gap_m;
}

double promise_mps(const CorridorGaps& gaps, const Ego& ego, const DrivingSettings& settings) {
  const double limit_mps = settings.road.speed_limit_mps;
  if (gaps.front_gap_m >= std::min(settings.rules.leader_range_m, settings.planner.gap_range_m))
    return limit_mps;
  const double spare_m = std::max(0.0, gaps.front_gap_m - headway_m(ego.speed_mps, settings));
  return std::min(limit_mps, ego.speed_mps + gaps.front_rate_mps + spare_m / kHorizon_s);
}

}  // namespace corridor::driving
