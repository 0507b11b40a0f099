// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/td_floor.h"

#include <algorithm>
#include <chrono>

#include "learner/gemm.h"

namespace corridor::bench {

using learner::multiply;

TdFloor::TdFloor(const NetworkShape& shape, int batch)
    : shape_(shape),
      batch_(batch),
      parameters_(shape.parameters(), 0.01F),
      gradient_(shape.parameters(), 0.01F),
      moments_(shape.parameters(), 0.01F) {
  int width = shape.observations;
  for (const auto& layer : shape.layers()) width = std::max(width, layer.outputs);
  inputs_.assign(static_cast<std::size_t>(batch * width), 0.5F);
  outputs_.assign(static_cast<std::size_t>(batch * width), 0.5F);
}

void TdFloor::step() {
  const auto layers = shape_.layers();
  for (int pass = 0; pass < 3; ++pass) {
    for (const auto& layer : layers) {
      multiply('T', 'N', layer.outputs, batch_, layer.inputs, parameters_.data() + layer.weights,
               layer.inputs, inputs_.data(), layer.inputs, outputs_.data(), layer.outputs);
    }
  }
  for (std::size_t i = layers.size(); i-- > 0;) {
    const auto& layer = layers[i];
    multiply('N', 'T', layer.inputs, layer.outputs, batch_, inputs_.data(), layer.inputs,
             outputs_.data(), layer.outputs, gradient_.data() + layer.weights, layer.inputs);
    if (i == 0) break;
    multiply('N', 'N', layer.inputs, batch_, layer.outputs, parameters_.data() + layer.weights,
             layer.inputs, outputs_.data(), layer.outputs, inputs_.data(), layer.inputs);
  }
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    moments_[i] = 0.9F * moments_[i] + 0.1F * gradient_[i];
    parameters_[i] -= 1e-6F * moments_[i];
  }
  std::fill(inputs_.begin(), inputs_.end(), 0.5F);
}

double TdFloor::step_us(const NetworkShape& shape, int batch) {
  TdFloor floor(shape, batch);
  std::vector<double> times_us;
  for (int i = 0; i < 2000; ++i) {
    const auto start = std::chrono::steady_clock::now();
    floor.step();
    times_us.push_back(
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start)
            .count());
  }
  std::nth_element(times_us.begin(), times_us.begin() + 1000, times_us.end());
  return times_us[1000];
}

}  // namespace corridor::bench
