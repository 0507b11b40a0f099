// SPDX-License-Identifier: Apache-2.0
// The arithmetic that a training step of a Q-network cannot do without, and nothing else: the
// matrix products of three forward passes and one backward pass by BLAS, and one pass over
// parameters and moments.
#pragma once

#include <vector>

#include "proto/settings/transition.h"

namespace corridor::bench {

class TdFloor {
 public:
  TdFloor(const NetworkShape& shape, int batch);
  void step();

  // Microseconds of one step: the median of many.
  static double step_us(const NetworkShape& shape, int batch);

 private:
  NetworkShape shape_;
  int batch_;
  std::vector<float> parameters_;
  std::vector<float> gradient_;
  std::vector<float> moments_;
  std::vector<float> inputs_;
  std::vector<float> outputs_;
};

}  // namespace corridor::bench
