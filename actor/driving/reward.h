// SPDX-License-Identifier: Apache-2.0
// The two rewards (paper sections III-B and III-C), unscaled.
#pragma once

#include <vector>

#include "actor/driving/corridors.h"
#include "actor/driving/scene.h"
#include "actor/driving/skills.h"

namespace corridor::driving {

// r_BP for the step that led from lane `lane_before` to `after`: left_change when the ego is now in
// a lane further left, else 1 when its speed exceeds that lane's threshold, else 0.
double bp_reward(int lane_before, const Ego& after, const DrivingSettings& settings);

// What training adds to r_BP for a step, and no reported reward has: shaping of ours.
double bp_shaping(bool collided, bool lane_changed, const BpRewardSettings& settings);

// r_MoP: 1 when the ego is in the middle of `window` (the one that it acted in, not yet shifted)
// AND EITHER its speed is within speed_tolerance_mps of the BP's target speed OR every open
// corridor of the window is blocked (a leader within gap_range_m) and the smallest front gap among
// them is near d = headway_s * v + standstill_gap_m; minus acceleration_penalty * |acceleration|.
// `gaps` are those of `after`.
double mop_reward(const Scene& after, const std::vector<CorridorGaps>& gaps, const Window& window,
                  const DrivingSettings& settings);

}  // namespace corridor::driving
