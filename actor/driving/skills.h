// SPDX-License-Identifier: Apache-2.0
// The skills that the behaviour planner can ask for (paper section III-B), in one table: where each
// is to be had, and what the network that carries it out is shown: state pre-processing (section
// III-C), so that earning the MoP's reward, which is in its window's middle, carries the skill out.
//
// A further skill needs a row here, its functions, and proto's kSkillCount raised.
#pragma once

#include <iterator>
#include <span>
#include <vector>

#include "actor/driving/corridors.h"
#include "actor/driving/scene.h"
#include "proto/settings/named_networks.h"
#include "proto/settings/settings.h"

namespace corridor::driving {

// As many corridors as one lane has.
struct Window {
  int first = 0;           // the road's corridor at position 0; may lie off the road
  std::vector<bool> open;  // [N_c]; a closed corridor shows gaps 0 and must not be entered
  NetworkId network = NetworkId::kMop;  // that is to drive in it

  int size() const { return static_cast<int>(open.size()); }
  int middle() const { return size() / 2; }
  int position_of(int corridor) const { return corridor - first; }
  bool contains(int corridor) const { return corridor >= first && corridor < first + size(); }
  bool is_open(int corridor) const {
    return contains(corridor) && open[static_cast<std::size_t>(position_of(corridor))];
  }
};

// A window from that corridor on; those are open in which the ego stays between the two edges.
Window window_from(int first_corridor, double right_edge_m, double left_edge_m,
                   const DrivingSettings& settings);

// Of a skill that keeps to its lane: the one that the ego's centre is in; corridors in which the
// ego would intrude on another lane or leave the road are closed.
Window keep_window(int lane_change, const Ego& ego, const DrivingSettings& settings);

// Of a skill that leads to the lane `lane_change` (-1 or 1) to the left: placed so that the ego is
// one corridor off its middle, opposite to the direction of change; only corridors in which the ego
// would leave the road are closed.
Window switch_window(int lane_change, const Ego& ego, const DrivingSettings& settings);

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
