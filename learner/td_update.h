// One gradient step of a Q-network on a batch from replay: loss (td_loss.h), gradient-norm
// clipping, Adam, target network.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "learner/td_networks.h"
#include "proto/messages.h"
#include "proto/settings.h"

namespace corridor::learner {

// The state before the first update: target = online, no moments.
TdState initial_td_state(std::vector<float> parameters);

class TdUpdate {
 public:
  // `dqn`: which target, Huber delta, Adam's epsilon, clipping, how often the target is copied.
  // Throws Failure when the device is not there (check_device).
  TdUpdate(const NetworkShape& shape, const DqnSettings& dqn, const std::string& device,
           const TdState& state);

  struct Result {
    double loss = 0.0;              // before the step
    double q_value = 0.0;           // mean Q of the actions taken
    double gradient_norm = 0.0;     // before clipping
    std::vector<float> priorities;  // |TD error| of each row
  };

  // Trains on a batch that is not empty. Throws Failure when the rows do not fit the network or
  // training has diverged.
  Result update(const Batch& batch, double learning_rate);

  std::uint64_t updates() const { return updates_; }
  // Of the online network.
  std::vector<float> parameters() const { return networks_->parameters(); }
  TdState state() const { return networks_->state(); }

 private:
  NetworkShape shape_;
  DqnSettings dqn_;
  std::unique_ptr<TdNetworks> networks_;
  std::uint64_t updates_;
};

}  // namespace corridor::learner
