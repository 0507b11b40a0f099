// The rule-based motion planner (paper section IV: "achieve similar goals as the reward"), with the
// same actions as the learned one.
#pragma once

#include "actor/driving/planner.h"
#include "proto/settings/settings.h"

namespace corridor::driving {

// Moves towards the window's middle when the corridors there are free enough, otherwise to the
// safest; chooses the set-point that keeps the headway to whatever is ahead in the swath.
class RuleBasedMop : public MotionPlanner {
 public:
  // Throws Failure when no set-point change is below 0.
  explicit RuleBasedMop(const DrivingSettings& settings);
  int decide(const Situation& situation, const Window& window) override;

 private:
  int corridor_change(const Situation& situation, const Window& window) const;
  int goal_corridor(const Situation& situation, const Window& window) const;
  int speed_change(const Situation& situation, int corridor_change) const;
  // Whether a step towards `target` keeps a safe distance to the leader of these gaps.
  bool keeps_distance(const CorridorGaps& gaps, const Ego& ego, const Target& target) const;
  bool survives_hard_braking(double gap_m, double leader_mps, Ego ego, Target target) const;

  DrivingSettings settings_;
  Lanes lanes_;
};

}  // namespace corridor::driving
