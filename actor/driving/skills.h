// The skills that the behaviour planner can ask for (paper section III-B), in one table: where each
// is to be had, and what the network that carries it out is shown.
//
// A further skill needs a row here, its functions, and proto's kSkillCount raised.
#pragma once

#include <iterator>
#include <span>

#include "actor/driving/preprocessing.h"
#include "actor/driving/scene.h"
#include "proto/settings/named_networks.h"
#include "proto/settings/settings.h"

namespace corridor::driving {

struct Skill {
  const char* name;
  int lane_change;  // by how many lanes to the left it leads: -1 right, 0, 1
  // Both are called with lane_change. Whether it can be carried out from where the ego is:
  bool (*is_feasible)(int lane_change, const Ego& ego, const DrivingSettings& settings);
  Window (*window)(int lane_change, const Ego& ego, const DrivingSettings& settings);
  NetworkId network;  // that drives it: one of those fed with observe_mop
};

// A Command is a place in the table. The first skill is always feasible.
using Skills = std::span<const Skill>;

// The lane that it leads to exists (counted from the lane that the ego's middle is in).
bool has_lane(int lane_change, const Ego& ego, const DrivingSettings& settings);

// The paper's, all driven by the shared MoP.
inline constexpr Skill kSkills[] = {
    {"keep", 0, has_lane, keep_window, NetworkId::kMop},
    {"left", 1, has_lane, switch_window, NetworkId::kMop},
    {"right", -1, has_lane, switch_window, NetworkId::kMop},
};
static_assert(std::size(kSkills) == kSkillCount);

// CHECKs that there is such a place.
const Skill& skill_of(Command command, Skills skills = kSkills);

// The command, or the first one where it is not feasible.
Command feasible(Command command, const Ego& ego, const DrivingSettings& settings,
                 Skills skills = kSkills);

// What the skill's network is shown.
Window window_for(Command command, const Ego& ego, const DrivingSettings& settings,
                  Skills skills = kSkills);

}  // namespace corridor::driving
