// SPDX-License-Identifier: Apache-2.0
// The behaviour planner under which the MoP is trained (paper section III-D).
#pragma once

#include "actor/driving/planner.h"
#include "actor/driving/skills.h"
#include "proto/settings/settings.h"

namespace corridor::driving {

// Asks for a lane change about every hundred steps until the ego is there, and in between for
// periods of short random commands, since a trained BP flickers ([random_bp]). A function of the
// episode seed and of the steps and lanes seen; asks for nothing that is not feasible. `skills`
// outlives it.
class RandomBp : public BehaviourPlanner {
 public:
  explicit RandomBp(const DrivingSettings& settings, Skills skills = kSkills);
  void begin_episode(std::uint64_t episode_seed) override;
  Command decide(const Situation& situation) override;

 private:
  void begin_period(int step, int lane);
  int draw(int least, int most);  // uniform, both included

  DrivingSettings settings_;
  Skills skills_;
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
