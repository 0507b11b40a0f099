// SPDX-License-Identifier: Apache-2.0
// A behaviour planner that asks for one skill: the naive planners that tell whether a scenario's
// traffic needs a BP at all.
#pragma once

#include "actor/driving/planner.h"
#include "actor/driving/skills.h"
#include "proto/settings/settings.h"

namespace corridor::driving {

// The same at every step, where it is feasible. `skills` outlives it.
class FixedBp : public BehaviourPlanner {
 public:
  FixedBp(Command command, const DrivingSettings& settings, Skills skills = kSkills)
      : command_(command), settings_(settings), skills_(skills) {}

  void begin_episode(std::uint64_t) override {}
  Command decide(const Situation& situation) override {
    return feasible(command_, situation.scene.ego, settings_, skills_);
  }

 private:
  Command command_;
  DrivingSettings settings_;
  Skills skills_;
};

}  // namespace corridor::driving
