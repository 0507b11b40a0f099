// Forward and backward passes of a Q-network (proto/settings/transition.h: NetworkShape) on the
// CPU, over flat parameters: matrix products by BLAS (Debian's LibTorch links the same one),
// everything between them in plain loops. For networks and batches this small LibTorch's operations
// cost more than their arithmetic.
#pragma once

#include <span>
#include <vector>

#include "proto/settings/transition.h"

namespace corridor::learner {

// One pass at a time; one thread. Matrices are row-major.
class DensePasses {
 public:
  explicit DensePasses(const NetworkShape& shape);

  // Q-values [batch, actions] of `batch` observations, the i-th of which begins at
  // observations[i * stride]. Both stay valid, and the observations must, until the next forward
  // pass.
  std::span<const float> forward(std::span<const float> parameters, const float* observations,
                                 int stride, int batch);

  // Sets `gradient` to d loss / d parameters, given d loss / d Q-values of the last forward pass
  // and the same parameters.
  void backward(std::span<const float> parameters, std::span<const float> q_gradient,
                std::span<float> gradient);

 private:
  // What a layer reads: row i begins at data[i * stride].
  struct Inputs {
    const float* data = nullptr;
    int stride = 0;
  };
  void apply(const NetworkShape::Layer& layer, const float* parameters, Inputs inputs,
             float* outputs) const;
  void differentiate(const NetworkShape::Layer& layer, Inputs inputs, const float* output_gradient,
                     float* gradient) const;
  Inputs inputs_of(std::size_t hidden_layer) const;

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

}  // namespace corridor::learner
