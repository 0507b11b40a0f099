// SPDX-License-Identifier: Apache-2.0
// The forward pass of a Q-network for one observation at a time, in Eigen: an actor needs no
// LibTorch. tests/actor/policy holds it against the learner's.
#pragma once

#include <span>
#include <vector>

#include "actor/algebra/matrix.h"
#include "proto/settings/transition.h"

namespace corridor::policy {

// One thread owns it. Cost: about a microsecond for 28-64-64-9.
class QNetwork {
 public:
  // `parameters` in NetworkShape's order, as many as it says (CHECK).
  QNetwork(NetworkShape shape, std::vector<float> parameters);

  // Q-values [actions]; valid until the next call.
  std::span<const float> q_values(std::span<const float> observation);

 private:
  NetworkShape shape_;
  std::vector<NetworkShape::Layer> layers_;
  std::vector<float> parameters_;
  std::vector<Vector> activations_;  // one a layer
};

}  // namespace corridor::policy
