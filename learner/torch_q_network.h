// A Q-network in LibTorch: a multi-layer perceptron whose parameters are one flat tensor, so that
// copies, checkpoints and Adam touch one array. Trained only on CUDA (torch_networks.cc); on the
// CPU cpu_networks.cc trains without LibTorch, which is what tests hold it against.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "proto/settings/choices.h"
#include "proto/settings/named_networks.h"
#include "proto/settings/transition.h"

namespace at {
class Tensor;
}

namespace corridor::learner {

// Where LibTorch is to compute (config key run.device). Throws Failure when it has no such device
// here.
void check_device(Device device);

// Keeps LibTorch to the calling thread; call it first in main.
void use_one_torch_thread();

// Of `networks` networks of this shape, one after the other: uniform in +-1/sqrt(fan-in), weights
// and biases alike, each a function of (seed, phase, index).
std::vector<float> initial_parameters(const NetworkShape& shape, std::uint64_t seed, Phase phase,
                                      int networks = 1);

class QNetwork {
 public:
  // All parameters 0. Throws Failure as check_device does.
  QNetwork(const NetworkShape& shape, Device device);
  ~QNetwork();
  QNetwork(const QNetwork&) = delete;
  QNetwork& operator=(const QNetwork&) = delete;

  const NetworkShape& shape() const;

  // In NetworkShape's order. One memcpy on the CPU.
  std::vector<float> parameters() const;
  void set_parameters(std::span<const float> values);

  // [batch, actions], row-major, for observations [batch, observations].
  std::vector<float> forward(std::span<const float> observations, int batch) const;

  // For torch_networks.cc: [batch, actions] for observations [batch, observations] on the network's
  // device, differentiable in parameter_tensor().
  at::Tensor forward(const at::Tensor& observations) const;
  at::Tensor& parameter_tensor();  // [parameters]

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace corridor::learner
