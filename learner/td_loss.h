// The loss of a Q-network on a batch of n-step transitions, and its derivative: Double DQN
// (van Hasselt et al. 2016) or DQN, Huber, importance weights. Pure.
#pragma once

#include <span>
#include <vector>

#include "proto/transition.h"

namespace corridor::learner {

struct TdLossSettings {
  bool double_q = true;
  double huber_delta = 1.0;
};

// What the networks say about a batch; each [batch, actions], row-major.
struct BatchQValues {
  std::span<const float> online;       // at the observations
  std::span<const float> online_next;  // at the next observations; unused by plain DQN
  std::span<const float> target_next;  // by the target network, at the next observations
};

struct TdLoss {
  double loss = 0.0;              // mean over the batch of weight * Huber(TD error)
  double q_value = 0.0;           // mean of Q(observation, action taken)
  std::vector<float> priorities;  // |TD error| of each row
  std::vector<float> q_gradient;  // d loss / d online, [batch, actions]
};

// TD error = Q(s, a) - (return + discount * Q_target(s', argmax Q_online(s', .))), the maximum of
// Q_target for plain DQN; of equal values the first counts. `rows` are whole rows of the layout,
// one importance weight each. Throws Failure on an action that the network does not have and on a
// TD error that is not finite (training has diverged).
TdLoss td_loss(std::span<const float> rows, const RowLayout& layout, std::span<const float> weights,
               const BatchQValues& q, int actions, const TdLossSettings& settings);

}  // namespace corridor::learner
