// SPDX-License-Identifier: Apache-2.0
#include "actor/driving/action.h"

#include <algorithm>
#include <cmath>

#include "proto/base/failure.h"

namespace corridor::driving {

MopAction mop_action(int index) {
  CORRIDOR_CHECK(index >= 0, "action {}", index);
  return {index % 3 - 1, index / 3};
}

int index_of(const MopAction& action) {
  CORRIDOR_CHECK(action.corridor_change >= -1 && action.corridor_change <= 1, "corridor change {}",
                 action.corridor_change);
  return 3 * action.speed_change + action.corridor_change + 1;
}

int unchanged_speed(const DrivingSettings& settings) {
  const auto& changes_mps = settings.planner.speed_changes_mps;
  const auto unchanged = std::ranges::min_element(
      changes_mps, {}, [](double change_mps) { return std::abs(change_mps); });
  return static_cast<int>(unchanged - changes_mps.begin());
}

Target target_for(const MopAction& action, const Ego& ego, const DrivingSettings& settings) {
  const auto& changes_mps = settings.planner.speed_changes_mps;
  CORRIDOR_CHECK(
      action.speed_change >= 0 && action.speed_change < static_cast<int>(changes_mps.size()),
      "speed change {} of {}", action.speed_change, changes_mps.size());

  const Lanes lanes(settings);
  const auto on_road = [&](int corridor) {
    return lanes.fits(corridor, settings.ego.width_m, 0.0, lanes.road_width_m());
  };
  int rightmost = 0;
  int leftmost = lanes.corridors() - 1;
  while (rightmost < leftmost && !on_road(rightmost)) ++rightmost;
  while (leftmost > rightmost && !on_road(leftmost)) --leftmost;

  const int corridor = lanes.corridor_at(ego.d_m) + action.corridor_change;
  const double set_point_mps =
      ego.set_point_mps + changes_mps[static_cast<std::size_t>(action.speed_change)];
  return {std::clamp(corridor, rightmost, leftmost),
          std::clamp(set_point_mps, 0.0, settings.road.speed_limit_mps)};
}

std::uint8_t pack(Command command, int mop_action_index, int skills) {
  const int packed = skills * mop_action_index + static_cast<int>(command);
  CORRIDOR_CHECK(mop_action_index >= 0 && packed <= 255, "action {}", mop_action_index);
  return static_cast<std::uint8_t>(packed);
}

StepAction unpack(std::uint8_t packed, int skills) {
  return {static_cast<Command>(packed % skills), packed / skills};
}

}  // namespace corridor::driving
