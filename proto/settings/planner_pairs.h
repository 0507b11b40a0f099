// SPDX-License-Identifier: Apache-2.0
// The pairs of planners that can be evaluated, in the order of a table's rows: those of the paper's
// Table I, those behind the safety shield, the naive ones that a table must be read against, and
// those under the BP of MoP training. What the command may ask an actor for.
#pragma once

#include <algorithm>
#include <string_view>

#include "proto/base/failure.h"
#include "proto/base/text.h"
#include "proto/settings/choices.h"

namespace corridor {

enum class BpKind {
  kLearned,
  kRules,
  kAlwaysKeep,  // asks for the same at every step
  kAlwaysLeft,
  kAlwaysRight,
  kRandom,  // the one that the MoP is trained under: tells how well a MoP serves
  kNone,    // SUMO's own driver model drives: there is no planner
};
enum class MopKind { kLearned, kRules, kNone };

struct PlannerPair {
  const char* name;
  const char* meaning;
  BpKind bp;
  MopKind mop;
  bool by_default;        // evaluated when no pairs are named
  bool shielded = false;  // the MoP's actions pass the safety shield (actor/driving/shield.h)

  bool world_drives() const { return bp == BpKind::kNone; }
  // SUMO's driver has no dynamics of its own.
  bool drives_in(WorldKind world) const {
    return !world_drives() || world == WorldKind::kKinematic;
  }
  bool learned() const { return bp == BpKind::kLearned || mop == MopKind::kLearned; }
};

inline constexpr PlannerPair kPlannerPairs[] = {
    {"hierarchical", "learned BP over learned MoP", BpKind::kLearned, MopKind::kLearned, true},
    {"rules", "rule-based BP and MoP", BpKind::kRules, MopKind::kRules, true},
    {"rules+mop", "rule-based BP over learned MoP", BpKind::kRules, MopKind::kLearned, true},
    {"bp+rules", "learned BP over rule-based MoP", BpKind::kLearned, MopKind::kRules, true},
    {"sumo", "SUMO drives the ego", BpKind::kNone, MopKind::kNone, true},
    {"hierarchical+shield", "hierarchical behind the safety shield", BpKind::kLearned,
     MopKind::kLearned, false, true},
    {"rules+shield", "rules behind the safety shield", BpKind::kRules, MopKind::kRules, false,
     true},
    {"rules+mop+shield", "rules+mop behind the safety shield", BpKind::kRules, MopKind::kLearned,
     false, true},
    {"left+rules", "go to the left lane and stay", BpKind::kAlwaysLeft, MopKind::kRules, false},
    {"left+mop", "go to the left lane and stay", BpKind::kAlwaysLeft, MopKind::kLearned, false},
    {"keep+mop", "stay in the lane", BpKind::kAlwaysKeep, MopKind::kLearned, false},
    {"keep+rules", "stay in the lane", BpKind::kAlwaysKeep, MopKind::kRules, false},
    {"right+rules", "go to the right lane and stay", BpKind::kAlwaysRight, MopKind::kRules, false},
    {"right+mop", "go to the right lane and stay", BpKind::kAlwaysRight, MopKind::kLearned, false},
    {"random+rules", "the BP of MoP training", BpKind::kRandom, MopKind::kRules, false},
    {"random+mop", "the BP of MoP training", BpKind::kRandom, MopKind::kLearned, false},
};

// Throws Failure naming the pairs that there are.
inline const PlannerPair& planner_pair(std::string_view name) {
  const auto found = std::ranges::find(kPlannerPairs, name, &PlannerPair::name);
  if (found != std::end(kPlannerPairs)) return *found;
  throw Failure("there is no planner '{}'; choose among {}", name,
                listed(kPlannerPairs, ", ", &PlannerPair::name));
}

}  // namespace corridor
