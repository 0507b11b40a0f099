// SPDX-License-Identifier: Apache-2.0
#include "actor/policy/q_network.h"

#include <utility>

#include "proto/base/failure.h"

namespace corridor::policy {
namespace {

void apply(const NetworkShape::Layer& layer, const std::vector<float>& parameters,
           const VectorView& input, Vector& output) {
  const RowMajorMap weights(parameters.data() + layer.weights, layer.outputs, layer.inputs);
  const VectorMap biases(parameters.data() + layer.biases, layer.outputs);
  output.noalias() = weights * input;
  output += biases;
}

}  // namespace

QNetwork::QNetwork(NetworkShape shape, std::vector<float> parameters)
    : shape_(std::move(shape)), layers_(shape_.layers()), parameters_(std::move(parameters)) {
  CORRIDOR_CHECK(parameters_.size() == shape_.parameters(), "{} parameters for a network of {}",
                 parameters_.size(), shape_.parameters());
  for (const auto& layer : layers_) activations_.emplace_back(layer.outputs);
}

std::span<const float> QNetwork::q_values(std::span<const float> observation) {
  CORRIDOR_CHECK(observation.size() == static_cast<std::size_t>(shape_.observations),
                 "{} numbers for {} inputs", observation.size(), shape_.observations);
  const VectorMap input(observation.data(), static_cast<int>(observation.size()));
  const std::size_t hidden = shape_.hidden.size();
  for (std::size_t i = 0; i < hidden; ++i) {
    if (i == 0) {
      apply(layers_[i], parameters_, input, activations_[i]);
    } else {
      apply(layers_[i], parameters_, activations_[i - 1], activations_[i]);
    }
    activations_[i] = activations_[i].cwiseMax(0.0f);
  }
  const auto& last_hidden = activations_[hidden - 1];
  Vector& q = activations_.back();
  apply(layers_.back(), parameters_, last_hidden, q);
  if (shape_.dueling) {
    Vector& value = activations_[hidden];
    apply(layers_[hidden], parameters_, last_hidden, value);
    q.array() += value[0] - q.mean();
  }
  return {q.data(), static_cast<std::size_t>(q.size())};
}

}  // namespace corridor::policy
