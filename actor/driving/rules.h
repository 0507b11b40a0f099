// SPDX-License-Identifier: Apache-2.0
// The rule-based planners (paper section IV: "achieve similar goals as the reward"), the MoP's with
// the same actions as the learned one.
#pragma once

#include "actor/driving/planner.h"
#include "proto/settings/settings.h"

namespace corridor::driving {

// What they reckon with on the way to a leader. Pure arithmetic.

double braking_way_m(double speed_mps, double braking_mps2);

// The way lost to a vehicle that closes in, until the speeds are equal.
double closing_way_m(double rate_mps, double braking_mps2);

// The distance to follow at, d of the MoP's reward.
double headway_m(double speed_mps, const DrivingSettings& settings);

// The speed to be had behind a leader for a while: the limit where none is in range.
double promise_mps(const CorridorGaps& gaps, const Ego& ego, const DrivingSettings& settings);

// Leaves a lane that is too slow for one that promises more and has room, the left one first; goes
// back right when nothing is in its way there. Keeps asking until the ego has arrived, and cancels
// when the room is gone.
class RuleBasedBp : public BehaviourPlanner {
 public:
  explicit RuleBasedBp(const DrivingSettings& settings);
  void begin_episode(std::uint64_t episode_seed) override;
  Command decide(const Situation& situation) override;

 private:
  int better_lane(const Scene& scene, int lane) const;  // or -1
  double lane_promise_mps(const Scene& scene, int lane) const;
  // At least this share of the gaps that a change to the lane needs.
  bool has_room(const Scene& scene, int lane, double share) const;

  DrivingSettings settings_;
  Lanes lanes_;
  int goal_lane_ = -1;  // of the change under way; -1: none
};

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
