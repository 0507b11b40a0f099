// The rule-based planners (paper section IV: "achieve similar goals as the reward"), with the same
// actions as the learned ones, and the random BP that the MoP is trained under.
#pragma once

#include "actor/driving/planner.h"
#include "proto/settings/settings.h"

namespace corridor::driving {

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

// Asks for the same at every step, "keep" once there is no lane to change to: the naive planners
// that tell whether a scenario's traffic needs a BP at all.
class ConstantBp : public BehaviourPlanner {
 public:
  ConstantBp(Command command, const DrivingSettings& settings);
  void begin_episode(std::uint64_t) override {}
  Command decide(const Situation& situation) override;

 private:
  Command command_;
  DrivingSettings settings_;
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

// Asks for a lane change about every hundred steps until the ego is there, and in between for
// periods of short random commands, since a trained BP flickers ([random_bp]). A function of the
// episode seed and of the steps and lanes seen; never asks for a lane that does not exist.
class RandomBp : public BehaviourPlanner {
 public:
  explicit RandomBp(const DrivingSettings& settings);
  void begin_episode(std::uint64_t episode_seed) override;
  Command decide(const Situation& situation) override;

 private:
  void begin_period(int step, int lane);
  int draw(int least, int most);  // uniform, both included

  DrivingSettings settings_;
  Lanes lanes_;
  std::uint64_t seed_ = 0;
  std::uint64_t draws_ = 0;
  int goal_lane_ = -1;  // asked for until reached; -1: none
  bool flickers_ = false;
  int period_ends_ = 0;   // step
  int command_ends_ = 0;  // step, while flickering
  Command command_ = Command::kKeep;
};

}  // namespace corridor::driving
