// SPDX-License-Identifier: Apache-2.0
// One gradient step of a planner's networks on a batch from replay: loss (td_loss.h), gradient-norm
// clipping, Adam, target network; each for the reward's network, and for the risk's where there is
// one. Both evaluate the same greedy policy, of Q - risk_weight * max(0, risk).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "learner/td_networks.h"
#include "proto/settings/settings.h"
#include "proto/wire/messages.h"

namespace corridor::learner {

// Of `networks` networks of this shape, one after the other: uniform in +-1/sqrt(fan-in), weights
// and biases alike, each a function of (seed, phase, index).
std::vector<float> initial_parameters(const NetworkShape& shape, std::uint64_t seed, Phase phase,
                                      int networks = 1);

// The state before the first update: target = online, no moments.
TdState initial_td_state(const std::vector<float>& parameters);

class TdUpdate {
 public:
  // `shape` of one network, `state` of all of them, one after the other. `dqn`: which networks and
  // target, Huber delta, Adam's epsilon, clipping, how often the target is copied.
  // Throws Failure when the device is not there (check_device).
  TdUpdate(const NetworkShape& shape, const DqnSettings& dqn, Device device, const TdState& state);

  struct Result {
    double loss = 0.0;              // before the step, summed over the networks
    double q_value = 0.0;           // mean Q of the actions taken
    double risk = 0.0;              // and mean risk
    double gradient_norm = 0.0;     // of the reward's network, before clipping
    std::vector<float> priorities;  // |TD error| of each row, summed over the networks
  };

  // Trains on a batch that is not empty. Throws Failure when the rows do not fit the network or
  // training has diverged.
  Result update(const Batch& batch, double learning_rate);

  std::uint64_t updates() const { return updates_; }
  // Of the online networks.
  std::vector<float> parameters() const;
  TdState state() const;

 private:
  NetworkShape shape_;
  DqnSettings dqn_;
  std::vector<std::unique_ptr<TdNetworks>> networks_;  // reward, and risk where there is one
  std::uint64_t updates_;
};

}  // namespace corridor::learner
