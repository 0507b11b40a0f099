// SPDX-License-Identifier: Apache-2.0
// The learned planners, and the planners that make up a pair.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <vector>

#include "actor/driving/planner.h"
#include "actor/policy/action_values.h"
#include "proto/settings/named_networks.h"
#include "proto/settings/planner_pairs.h"
#include "proto/settings/settings.h"

namespace corridor::actor {

// Greedy on the learned values.
class QBehaviourPlanner : public driving::BehaviourPlanner {
 public:
  QBehaviourPlanner(const RunConfig& config, const Networks& networks);
  void begin_episode(std::uint64_t) override {}
  driving::Command decide(const driving::Situation& situation) override;
  // Of the commands; valid until the next call.
  std::span<const float> values(const driving::Situation& situation);

 private:
  DrivingSettings settings_;
  policy::ActionValues values_;
  std::vector<float> observation_;
};

class QMotionPlanner : public driving::MotionPlanner {
 public:
  QMotionPlanner(const RunConfig& config, const Networks& networks);
  int decide(const driving::Situation& situation, const driving::Window& window) override;
  // Of the MoP's actions, by the window's network; valid until the next call.
  std::span<const float> values(const driving::Situation& situation, const driving::Window& window);

 private:
  DrivingSettings settings_;
  std::map<NetworkId, policy::ActionValues> values_;  // of every network that drives a skill
  std::vector<float> observation_;
};

// Null where the pair has no planner.
std::unique_ptr<driving::BehaviourPlanner> make_behaviour_planner(const PlannerPair& pair,
                                                                  const RunConfig& config,
                                                                  const Networks& networks);
std::unique_ptr<driving::MotionPlanner> make_motion_planner(const PlannerPair& pair,
                                                            const RunConfig& config,
                                                            const Networks& networks);

}  // namespace corridor::actor
