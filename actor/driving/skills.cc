// SPDX-License-Identifier: Apache-2.0
#include "actor/driving/skills.h"

#include "proto/base/failure.h"

namespace corridor::driving {

Window window_from(int first_corridor, double right_edge_m, double left_edge_m,
                   const DrivingSettings& settings) {
  const Lanes lanes(settings);
  Window window{first_corridor, std::vector<bool>(static_cast<std::size_t>(lanes.per_lane()))};
  for (int position = 0; position < window.size(); ++position) {
    window.open[static_cast<std::size_t>(position)] =
        lanes.fits(first_corridor + position, settings.ego.width_m, right_edge_m, left_edge_m);
  }
  return window;
}

Window keep_window(int, const Ego& ego, const DrivingSettings& settings) {
  const Lanes lanes(settings);
  const int lane = lanes.lane_at(ego.d_m);
  const double right_edge_m = lane * lanes.lane_width_m();
  return window_from(lane * lanes.per_lane(), right_edge_m, right_edge_m + lanes.lane_width_m(),
                     settings);
}

Window switch_window(int lane_change, const Ego& ego, const DrivingSettings& settings) {
  const Lanes lanes(settings);
  const int middle = lanes.corridor_at(ego.d_m) + lane_change;
  return window_from(middle - lanes.per_lane() / 2, 0.0, lanes.road_width_m(), settings);
}

bool has_lane(int lane_change, const Ego& ego, const DrivingSettings& settings) {
  const Lanes lanes(settings);
  const int lane = lanes.lane_at(ego.d_m) + lane_change;
  return lane >= 0 && lane < lanes.lanes();
}

const Skill& skill_of(Command command, Skills skills) {
  const auto place = static_cast<std::size_t>(command);
  CORRIDOR_CHECK(place < skills.size(), "command {} of {}", place, skills.size());
  return skills[place];
}

Command feasible(Command command, const Ego& ego, const DrivingSettings& settings, Skills skills) {
  const Skill& skill = skill_of(command, skills);
  return skill.is_feasible(skill.lane_change, ego, settings) ? command : Command{};
}

Window window_for(Command command, const Ego& ego, const DrivingSettings& settings, Skills skills) {
  const Skill& skill = skill_of(command, skills);
  Window window = skill.window(skill.lane_change, ego, settings);
  window.network = skill.network;
  return window;
}

}  // namespace corridor::driving
