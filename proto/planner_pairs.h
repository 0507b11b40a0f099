// The pairs of planners that can be evaluated: the rows of the paper's Table I, in its order. What
// the command may ask an actor for.
#pragma once

#include <string_view>

namespace corridor {

struct PlannerPair {
  const char* name;
  const char* meaning;
  bool learned_bp;
  bool learned_mop;
  bool world_drives;  // SUMO's own driver model: there is no planner
};

inline constexpr PlannerPair kPlannerPairs[] = {
    {"hierarchical", "learned BP over learned MoP", true, true, false},
    {"rules", "rule-based BP and MoP", false, false, false},
    {"rules+mop", "rule-based BP over learned MoP", false, true, false},
    {"bp+rules", "learned BP over rule-based MoP", true, false, false},
    {"sumo", "SUMO drives the ego", false, false, true},
};

// Throws Failure naming the pairs that there are.
const PlannerPair& planner_pair(std::string_view name);

}  // namespace corridor
