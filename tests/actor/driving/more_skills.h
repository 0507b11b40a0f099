// SPDX-License-Identifier: Apache-2.0
// The paper's skills and one more: half a lane to the left, to the edge of the lane.
#pragma once

#include "actor/driving/corridors.h"
#include "actor/driving/skills.h"

namespace corridor::driving {

inline Window half_left_window(int, const Ego& ego, const DrivingSettings& settings) {
  const Lanes lanes(settings);
  const int lane = lanes.lane_at(ego.d_m);
  return window_from(lanes.middle_of_lane(lane), 0.0, lanes.road_width_m(), settings);
}

inline constexpr Command kHalfLeft{3};
inline constexpr Skill kMoreSkills[] = {
    kSkills[0],
    kSkills[1],
    kSkills[2],
    {"half left", 1, has_lane, half_left_window, NetworkId::kBp},
};

}  // namespace corridor::driving
