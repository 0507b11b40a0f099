// SPDX-License-Identifier: Apache-2.0
// The online and the target network of a training step, and what the step does to them. Two ways to
// compute it: on the CPU by BLAS and our own loops, forward, backward and Adam, without LibTorch
// (cpu_networks.cc); by LibTorch's autograd and Adam (torch_networks.cc), which trains on CUDA and
// is what the first is tested against on the CPU.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "learner/td_loss.h"
#include "proto/settings/settings.h"
#include "proto/settings/transition.h"

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

class TdNetworks {
 public:
  virtual ~TdNetworks() = default;

  // Q-values of whole rows (proto/settings/transition.h: RowLayout): by the online network at the
  // observations, by both at the next observations (the online one's only where double_q wants
  // them). `rows` and the answer stay valid until the next call.
  virtual BatchQValues forward(std::span<const float> rows, int batch) = 0;

  // Given d loss / d online of that forward pass: the gradient, clipped to gradient_norm_max, into
  // Adam. Returns the gradient's norm before clipping.
  virtual double step(std::span<const float> q_gradient, double learning_rate) = 0;

  virtual void copy_to_target() = 0;

  virtual std::vector<float> parameters() const = 0;  // of the online network
  virtual TdState state() const = 0;                  // updates: steps so far
};

// Where LibTorch is to compute (config key run.device). Throws Failure when it has no such device
// here.
void check_device(Device device);

// Keeps LibTorch to the calling thread; call it first in main.
void use_one_torch_thread();

// `state`'s vectors have the shape's size. torch_networks throws Failure as check_device does.
std::unique_ptr<TdNetworks> cpu_networks(const NetworkShape& shape, const DqnSettings& dqn,
                                         const TdState& state);
std::unique_ptr<TdNetworks> torch_networks(const NetworkShape& shape, const DqnSettings& dqn,
                                           Device device, const TdState& state);

}  // namespace corridor::learner
