// The forward pass of a Q-network for one observation at a time, in Eigen: an actor needs no
// LibTorch. tests/actor/policy holds it against the learner's.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "proto/transition.h"

namespace corridor::policy {

// One thread owns it. Cost: about a microsecond for 28-64-64-9.
class QNetwork {
 public:
  // `parameters` in NetworkShape's order, as many as it says (CHECK).
  QNetwork(NetworkShape shape, std::vector<float> parameters);

  const NetworkShape& shape() const { return shape_; }

  // Q-values [actions]; valid until the next call.
  std::span<const float> q_values(std::span<const float> observation);

  // The action of the largest Q-value, the lowest of equals.
  int greedy(std::span<const float> observation);

 private:
  NetworkShape shape_;
  std::vector<NetworkShape::Layer> layers_;
  std::vector<float> parameters_;
  std::vector<Eigen::VectorXf> activations_;  // one a layer
};

int argmax(std::span<const float> values);

// |n-step TD error| of each row by `network` alone (Horgan et al. 2018: actors compute initial
// priorities with the weights that they have): |return + discount * max Q(next) - Q(now, action)|.
std::vector<float> td_errors(std::span<const float> rows, QNetwork& network);

}  // namespace corridor::policy
