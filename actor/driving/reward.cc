// SPDX-License-Identifier: Apache-2.0
#include "actor/driving/reward.h"

#include <algorithm>
#include <cmath>

#include "proto/base/failure.h"

namespace corridor::driving {
namespace {

// Whether the window leaves nothing but to follow, and the ego follows at the distance wanted.
bool follows(const Ego& ego, const std::vector<CorridorGaps>& gaps, const Window& window,
             const DrivingSettings& settings) {
  const double range_m = settings.planner.gap_range_m;
  double smallest_gap_m = range_m;
  for (int corridor = window.first; corridor < window.first + window.size(); ++corridor) {
    if (!window.is_open(corridor)) continue;
    const double gap_m = gaps[static_cast<std::size_t>(corridor)].front_gap_m;
    if (gap_m >= range_m) return false;
    smallest_gap_m = std::min(smallest_gap_m, gap_m);
  }
  if (smallest_gap_m >= range_m) return false;  // a window without an open corridor
  const MopRewardSettings& reward = settings.mop_reward;
  const double wanted_m = reward.headway_s * ego.speed_mps + reward.standstill_gap_m;
  return smallest_gap_m >= reward.near_low * wanted_m &&
         smallest_gap_m <= reward.near_high * wanted_m + reward.near_high_offset_m;
}

}  // namespace

double bp_reward(int lane_before, const Ego& after, const DrivingSettings& settings) {
  const int lane = Lanes(settings).lane_at(after.d_m);
  if (lane > lane_before) return settings.bp_reward.left_change;
  const auto& thresholds_mps = settings.bp_reward.thresholds_mps;
  return after.speed_mps > thresholds_mps[static_cast<std::size_t>(lane)] ? 1.0 : 0.0;
}

double bp_shaping(bool collided, bool lane_changed, const BpRewardSettings& settings) {
  return (collided ? settings.collision_shaping : 0.0) +
         (lane_changed ? settings.lane_change_shaping : 0.0);
}

double mop_reward(const Scene& after, const std::vector<CorridorGaps>& gaps, const Window& window,
                  const DrivingSettings& settings) {
  const Lanes lanes(settings);
  CORRIDOR_CHECK(static_cast<int>(gaps.size()) == lanes.corridors(), "{} gaps", gaps.size());
  const Ego& ego = after.ego;
  const MopRewardSettings& reward = settings.mop_reward;
  const bool in_middle = window.position_of(lanes.corridor_at(ego.d_m)) == window.middle();
  const bool at_target_speed =
      std::abs(ego.speed_mps - settings.road.speed_limit_mps) < reward.speed_tolerance_mps;
  const bool earned = in_middle && (at_target_speed || follows(ego, gaps, window, settings));
  return (earned ? 1.0 : 0.0) - reward.acceleration_penalty * std::abs(ego.acceleration_mps2);
}

}  // namespace corridor::driving
