#include "actor/driving/skills.h"

#include "actor/driving/corridors.h"
#include "proto/base/failure.h"

namespace corridor::driving {

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
