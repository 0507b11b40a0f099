// SPDX-License-Identifier: Apache-2.0
// Adam (Kingma and Ba 2015, algorithm 1, with PyTorch's constants and order of operations) after
// clipping the gradient's norm, over flat vectors: one loop each. Pure.
#pragma once

#include <cstdint>
#include <span>

namespace corridor::learner {

// What Adam keeps for each parameter.
struct AdamMoments {
  std::span<float> mean_gradient;
  std::span<float> mean_squared_gradient;
};

// Euclidean. In a fixed order of additions.
double norm(std::span<const float> values);

// The step-th step, from 1 on, with `gradient` times `scale`. All of one size (CHECK).
void adam_step(std::span<float> parameters, std::span<const float> gradient, AdamMoments moments,
               float scale, double learning_rate, double epsilon, std::uint64_t step);

}  // namespace corridor::learner
