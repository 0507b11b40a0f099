// SPDX-License-Identifier: Apache-2.0
// What a learned planner compares its actions by: Q-values of the reward, less the weighted risk.
#pragma once

#include <span>
#include <vector>

#include "actor/policy/q_network.h"
#include "proto/settings/settings.h"

namespace corridor::policy {

// One thread owns it.
class ActionValues {
 public:
  // `parameters` as RunConfig::parameters says (CHECK).
  ActionValues(const DqnSettings& dqn, PlannerShape shape, std::span<const float> parameters);

  // Q(s, a) - risk_weight * max(0, R(s, a)), [actions]; valid until the next call.
  std::span<const float> values(std::span<const float> observation);

  // The action of the largest value, the lowest of equals.
  int greedy(std::span<const float> observation);

  // The sum of both networks' |n-step TD error| of each row, by these networks alone (Horgan et al.
  // 2018: actors compute initial priorities with the weights that they have); with the greedy
  // action b at the next observation: |return + discount * Q(next, b) - Q(now, action)|.
  std::vector<float> td_errors(std::span<const float> rows);

 private:
  struct Chosen {
    float q = 0.0f;
    float risk = 0.0f;
  };
  // Of the action at the observation.
  Chosen look_up(std::span<const float> observation, int action);

  float risk_weight_;
  int observations_;
  std::vector<QNetwork> networks_;  // reward, and risk where there is one
  std::vector<float> values_;
};

int argmax(std::span<const float> values);

}  // namespace corridor::policy
