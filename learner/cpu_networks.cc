// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numeric>

#include "learner/adam.h"
#include "learner/gemm.h"
#include "learner/td_networks.h"
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

// Forward and backward passes of a Q-network (proto/settings/transition.h: NetworkShape) over flat
// parameters: matrix products by BLAS (Debian's LibTorch links the same one), everything between
// them in plain loops. For networks and batches this small LibTorch's operations cost more than
// their arithmetic. One pass at a time. Matrices are row-major.
class DensePasses {
 public:
  explicit DensePasses(const NetworkShape& shape)
      : shape_(shape),
        layers_(shape.layers()),
        hidden_(shape.hidden.size()),
        hidden_gradient_(shape.hidden.size()) {}

  // Q-values [batch, actions] of `batch` observations, the i-th of which begins at
  // observations[i * stride]. Both stay valid, and the observations must, until the next forward
  // pass.
  std::span<const float> forward(std::span<const float> parameters, const float* observations,
                                 int stride, int batch) {
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

  // Sets `gradient` to d loss / d parameters, given d loss / d Q-values of the last forward pass
  // and the same parameters.
  void backward(std::span<const float> parameters, std::span<const float> q_gradient,
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
    differentiate(layers_.back(), inputs_of(hidden_.size()), last_gradient_.data(),
                  gradient.data());

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

 private:
  // What a layer reads: row i begins at data[i * stride].
  struct Inputs {
    const float* data = nullptr;
    int stride = 0;
  };

  Inputs inputs_of(std::size_t hidden_layer) const {
    if (hidden_layer == 0) return observations_;
    return {hidden_[hidden_layer - 1].data(), shape_.hidden[hidden_layer - 1]};
  }

  // outputs = inputs weights^T + biases; a row-major matrix is a column-major one transposed.
  void apply(const NetworkShape::Layer& layer, const float* parameters, Inputs inputs,
             float* outputs) const {
    multiply('T', 'N', layer.outputs, batch_, layer.inputs, parameters + layer.weights,
             layer.inputs, inputs.data, inputs.stride, outputs, layer.outputs);
    add_to_rows(parameters + layer.biases, batch_, layer.outputs, outputs);
  }

  // d weights = output_gradient^T inputs; d biases = its column sums.
  void differentiate(const NetworkShape::Layer& layer, Inputs inputs, const float* output_gradient,
                     float* gradient) const {
    multiply('N', 'T', layer.inputs, layer.outputs, batch_, inputs.data, inputs.stride,
             output_gradient, layer.outputs, gradient + layer.weights, layer.inputs);
    float* biases = gradient + layer.biases;
    std::fill_n(biases, layer.outputs, 0.0F);
    for (int i = 0; i < batch_; ++i) {
      const float* row = output_gradient + static_cast<std::ptrdiff_t>(i) * layer.outputs;
      for (int j = 0; j < layer.outputs; ++j) biases[j] += row[j];
    }
  }

  NetworkShape shape_;
  std::vector<NetworkShape::Layer> layers_;

  // Of the last forward pass.
  Inputs observations_;
  int batch_ = 0;
  std::vector<std::vector<float>> hidden_;  // after ReLU, by layer: [batch, width]
  std::vector<float> values_;               // of a dueling network: [batch, 1]
  std::vector<float> q_;                    // [batch, actions]

  // Scratch of `backward`.
  std::vector<float> value_gradient_;                // [batch, 1]
  std::vector<float> last_gradient_;                 // [batch, actions]
  std::vector<std::vector<float>> hidden_gradient_;  // by layer: [batch, width]
};

class CpuNetworks : public TdNetworks {
 public:
  CpuNetworks(const NetworkShape& shape, const DqnSettings& dqn, const TdState& state)
      : shape_(shape),
        dqn_(dqn),
        state_(state),
        gradient_(shape.parameters()),
        online_pass_(shape),
        online_next_pass_(shape),
        target_next_pass_(shape) {}

  BatchQValues forward(std::span<const float> rows, int batch) override {
    const auto stride = static_cast<int>(RowLayout{shape_.observations}.stride());
    const float* next = rows.data() + shape_.observations;
    BatchQValues q;
    q.target_next = target_next_pass_.forward(state_.target, next, stride, batch);
    if (dqn_.double_q) {
      q.online_next = online_next_pass_.forward(state_.online, next, stride, batch);
    }
    q.online = online_pass_.forward(state_.online, rows.data(), stride, batch);
    return q;
  }

  double step(std::span<const float> q_gradient, double learning_rate) override {
    online_pass_.backward(state_.online, q_gradient, gradient_);
    const double size = norm(gradient_);
    const double scale = size > dqn_.gradient_norm_max ? dqn_.gradient_norm_max / size : 1.0;
    adam_step(state_.online, gradient_, {state_.mean_gradient, state_.mean_squared_gradient},
              static_cast<float>(scale), learning_rate, dqn_.adam_epsilon, ++state_.updates);
    return size;
  }

  void copy_to_target() override { state_.target = state_.online; }

  std::vector<float> parameters() const override { return state_.online; }

  TdState state() const override { return state_; }

 private:
  NetworkShape shape_;
  DqnSettings dqn_;
  TdState state_;
  std::vector<float> gradient_;
  DensePasses online_pass_;
  DensePasses online_next_pass_;
  DensePasses target_next_pass_;
};

}  // namespace

std::unique_ptr<TdNetworks> cpu_networks(const NetworkShape& shape, const DqnSettings& dqn,
                                         const TdState& state) {
  return std::make_unique<CpuNetworks>(shape, dqn, state);
}

}  // namespace corridor::learner
