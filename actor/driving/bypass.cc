// SPDX-License-Identifier: Apache-2.0
#include "actor/driving/bypass.h"

#include <algorithm>
#include <cmath>

#include "actor/driving/corridors.h"

namespace corridor::driving {
namespace {

bool is_within(int lane, const Ego& ego, const DrivingSettings& settings) {
  constexpr double kRounding_m = 1e-9;
  const Lanes lanes(settings);
  const double off_middle_m = std::abs(ego.d_m - lanes.lane_centre_m(lane));
  return off_middle_m + settings.ego.width_m / 2 <= lanes.lane_width_m() / 2 + kRounding_m;
}

}  // namespace

int bypasses(const Scene& before, const Scene& after, const DrivingSettings& settings) {
  const int lane = Lanes(settings).lane_at(after.ego.d_m);
  if (!is_within(lane, before.ego, settings) || !is_within(lane, after.ego, settings)) return 0;
  return static_cast<int>(std::ranges::count_if(after.others, [&](const Vehicle& other) {
    const Vehicle* earlier = find_vehicle(before, other.id);
    return earlier != nullptr && before.ego.s_m < earlier->s_m && after.ego.s_m >= other.s_m &&
           Lanes(settings).lane_at(other.d_m) == lane;
  }));
}

}  // namespace corridor::driving
