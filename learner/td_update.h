// One gradient step of a Q-network on a batch from replay: loss (td_loss.h), gradient-norm
// clipping, Adam, target network.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "proto/messages.h"
#include "proto/settings.h"

namespace corridor::learner {

// Everything that the next update depends on besides its batch: importing it continues bit for bit.
struct TdState {
  std::vector<float> online;  // parameters, in NetworkShape's order
  std::vector<float> target;
  std::vector<float> mean_gradient;          // Adam's first moment
  std::vector<float> mean_squared_gradient;  // Adam's second moment
  std::uint64_t updates = 0;                 // also Adam's step
  bool operator==(const TdState&) const = default;
};

// The state before the first update: target = online, no moments.
TdState initial_td_state(std::vector<float> parameters);

class TdUpdate {
 public:
  // `dqn`: which target, Huber delta, Adam's epsilon, clipping, how often the target is copied.
  // Throws Failure when the device is not there (check_device).
  TdUpdate(const NetworkShape& shape, const DqnSettings& dqn, const std::string& device,
           const TdState& state);
  ~TdUpdate();
  TdUpdate(const TdUpdate&) = delete;
  TdUpdate& operator=(const TdUpdate&) = delete;

  struct Result {
    double loss = 0.0;              // before the step
    double q_value = 0.0;           // mean Q of the actions taken
    double gradient_norm = 0.0;     // before clipping
    std::vector<float> priorities;  // |TD error| of each row
  };

  // Trains on a batch that is not empty. Throws Failure when the rows do not fit the network or
  // training has diverged.
  Result update(const Batch& batch, double learning_rate);

  std::uint64_t updates() const;
  std::vector<float> parameters() const;  // of the online network
  TdState state() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace corridor::learner
