// The rule-based behaviour planner (paper section IV: "achieve similar goals as the reward").
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

}  // namespace corridor::driving
