#include "learner/dense_passes.h"

#include <algorithm>
#include <numeric>

#include "learner/gemm.h"
#include "proto/base/failure.h"

namespace corridor::learner {
namespace {

void add_to_rows(const float* biases, int rows, int width, float* matrix) {
  for (int i = 0; i < rows; ++i) {
    float* row = matrix + static_cast<std::ptrdiff_t>(i) * width;
    for (int j = 0; j < width; ++j) row[j] += biases[j];
  }
}

void relu(std::vector<float>& values) {
  for (float& value : values) value = value > 0.0F ? value : 0.0F;
}

// ReLU passes what is above 0.
void relu_backward(const std::vector<float>& outputs, std::vector<float>& gradient) {
  for (std::size_t i = 0; i < gradient.size(); ++i) {
    gradient[i] = outputs[i] > 0.0F ? gradient[i] : 0.0F;
  }
}

}  // namespace

DensePasses::DensePasses(const NetworkShape& shape)
    : shape_(shape),
      layers_(shape.layers()),
      hidden_(shape.hidden.size()),
      hidden_gradient_(shape.hidden.size()) {}

DensePasses::Inputs DensePasses::inputs_of(std::size_t hidden_layer) const {
  if (hidden_layer == 0) return observations_;
  return {hidden_[hidden_layer - 1].data(), shape_.hidden[hidden_layer - 1]};
}

// outputs = inputs weights^T + biases; a row-major matrix is a column-major one transposed.
void DensePasses::apply(const NetworkShape::Layer& layer, const float* parameters, Inputs inputs,
                        float* outputs) const {
  multiply('T', 'N', layer.outputs, batch_, layer.inputs, parameters + layer.weights, layer.inputs,
           inputs.data, inputs.stride, outputs, layer.outputs);
  add_to_rows(parameters + layer.biases, batch_, layer.outputs, outputs);
}

std::span<const float> DensePasses::forward(std::span<const float> parameters,
                                            const float* observations, int stride, int batch) {
  CORRIDOR_CHECK(parameters.size() == shape_.parameters() && batch > 0, "{} parameters, batch {}",
                 parameters.size(), batch);
  observations_ = {observations, stride};
  batch_ = batch;
  const auto rows = static_cast<std::size_t>(batch);
  for (std::size_t i = 0; i < hidden_.size(); ++i) {
    hidden_[i].resize(rows * static_cast<std::size_t>(shape_.hidden[i]));
    apply(layers_[i], parameters.data(), inputs_of(i), hidden_[i].data());
    relu(hidden_[i]);
  }
  const auto actions = static_cast<std::size_t>(shape_.actions);
  q_.resize(rows * actions);
  apply(layers_.back(), parameters.data(), inputs_of(hidden_.size()), q_.data());
  if (shape_.dueling) {
    values_.resize(rows);
    apply(layers_[hidden_.size()], parameters.data(), inputs_of(hidden_.size()), values_.data());
    for (std::size_t i = 0; i < rows; ++i) {
      const std::span<float> q(q_.data() + i * actions, actions);
      const float mean =
          std::accumulate(q.begin(), q.end(), 0.0F) / static_cast<float>(shape_.actions);
      for (float& advantage : q) advantage += values_[i] - mean;
    }
  }
  return q_;
}

// d weights = output_gradient^T inputs; d biases = its column sums.
void DensePasses::differentiate(const NetworkShape::Layer& layer, Inputs inputs,
                                const float* output_gradient, float* gradient) const {
  multiply('N', 'T', layer.inputs, layer.outputs, batch_, inputs.data, inputs.stride,
           output_gradient, layer.outputs, gradient + layer.weights, layer.inputs);
  float* biases = gradient + layer.biases;
  std::fill_n(biases, layer.outputs, 0.0F);
  for (int i = 0; i < batch_; ++i) {
    const float* row = output_gradient + static_cast<std::ptrdiff_t>(i) * layer.outputs;
    for (int j = 0; j < layer.outputs; ++j) biases[j] += row[j];
  }
}

void DensePasses::backward(std::span<const float> parameters, std::span<const float> q_gradient,
                           std::span<float> gradient) {
  CORRIDOR_CHECK(q_gradient.size() == q_.size() && gradient.size() == shape_.parameters(),
                 "{} Q-values, {} parameters", q_gradient.size(), gradient.size());
  const auto actions = static_cast<std::size_t>(shape_.actions);
  last_gradient_.assign(q_gradient.begin(), q_gradient.end());
  if (shape_.dueling) {
    value_gradient_.resize(static_cast<std::size_t>(batch_));
    for (std::size_t i = 0; i < value_gradient_.size(); ++i) {
      const std::span<float> advantages(last_gradient_.data() + i * actions, actions);
      value_gradient_[i] = std::accumulate(advantages.begin(), advantages.end(), 0.0F);
      const float mean = value_gradient_[i] / static_cast<float>(shape_.actions);
      for (float& advantage : advantages) advantage -= mean;
    }
    differentiate(layers_[hidden_.size()], inputs_of(hidden_.size()), value_gradient_.data(),
                  gradient.data());
  }
  differentiate(layers_.back(), inputs_of(hidden_.size()), last_gradient_.data(), gradient.data());

  const NetworkShape::Layer* above = &layers_.back();
  const float* output_gradient = last_gradient_.data();
  for (std::size_t i = hidden_.size(); i-- > 0;) {
    // d inputs = output_gradient weights
    hidden_gradient_[i].resize(hidden_[i].size());
    multiply('N', 'N', above->inputs, batch_, above->outputs, parameters.data() + above->weights,
             above->inputs, output_gradient, above->outputs, hidden_gradient_[i].data(),
             above->inputs);
    if (shape_.dueling && i + 1 == hidden_.size()) {
      const NetworkShape::Layer& value = layers_[hidden_.size()];
      multiply('N', 'N', value.inputs, batch_, 1, parameters.data() + value.weights, value.inputs,
               value_gradient_.data(), 1, hidden_gradient_[i].data(), value.inputs, 1.0F);
    }
    relu_backward(hidden_[i], hidden_gradient_[i]);
    differentiate(layers_[i], inputs_of(i), hidden_gradient_[i].data(), gradient.data());
    above = &layers_[i];
    output_gradient = hidden_gradient_[i].data();
  }
}

}  // namespace corridor::learner
