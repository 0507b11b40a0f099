// SPDX-License-Identifier: Apache-2.0
// The loss of a Q-network on a batch of n-step transitions, and its derivative: Double DQN
// (van Hasselt et al. 2016) or DQN, Huber, importance weights. Pure.
#pragma once

#include <span>
#include <vector>

#include "proto/settings/transition.h"

namespace corridor::learner {

// What a network says about a batch; each [batch, actions], row-major.
struct BatchQValues {
  std::span<const float> online;       // at the observations
  std::span<const float> online_next;  // at the next observations; unused by plain DQN
  std::span<const float> target_next;  // by the target network, at the next observations
};

// The greedy action at each next observation, [batch]: the largest Q - risk_weight * max(0, risk),
// the first of equals. `q` and `risk` are [batch, actions]; without a risk network `risk` is empty.
std::vector<std::size_t> greedy_actions(std::span<const float> q, std::span<const float> risk,
                                        double risk_weight, int actions);

// In which of a row's columns a network finds its return and its discount.
struct ReturnColumns {
  std::size_t n_step_return = 0;
  std::size_t discount = 0;
};

struct TdLoss {
  double loss = 0.0;              // mean over the batch of weight * Huber(TD error)
  double q_value = 0.0;           // mean of Q(observation, action taken)
  std::vector<float> priorities;  // |TD error| of each row
  std::vector<float> q_gradient;  // d loss / d online, [batch, actions]
};

// TD error = Q(s, a) - (return + discount * Q_target(s', next action)). `rows` are whole rows of
// the layout, one importance weight and one next action each. Throws Failure on an action that the
// network does not have and on a TD error that is not finite (training has diverged).
TdLoss td_loss(std::span<const float> rows, const RowLayout& layout, const ReturnColumns& columns,
               std::span<const float> weights, const BatchQValues& q,
               std::span<const std::size_t> next_actions, int actions, double huber_delta);

}  // namespace corridor::learner
