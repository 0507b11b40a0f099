// SPDX-License-Identifier: Apache-2.0
#include "learner/adam.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace corridor::learner {
namespace {

TEST(Norm, IsTheRootOfTheSumOfSquaresAtEverySize) {
  for (const std::size_t size : {0, 1, 15, 16, 17, 1000}) {
    std::vector<float> values;
    double sum = 0.0;
    for (std::size_t i = 0; i < size; ++i) {
      values.push_back(static_cast<float>(i % 7) - 3.0F);
      sum += values.back() * values.back();
    }
    EXPECT_NEAR(norm(values), std::sqrt(sum), 1e-5 * std::sqrt(sum)) << size;
  }
}

// The paper's algorithm in doubles.
TEST(AdamStep, FollowsThePaper) {
  std::vector<float> parameters = {1.0F, -2.0F, 0.5F}, mean(3), squared(3);
  std::vector<double> p(parameters.begin(), parameters.end()), m(3), v(3);
  for (int step = 1; step <= 50; ++step) {
    const std::vector<float> gradient = {std::sin(step * 1.0F), 0.3F, step % 2 == 0 ? 1e-3F : 0.0F};
    adam_step(parameters, gradient, {mean, squared}, 0.5F, 1e-2, 1e-8, step);
    for (std::size_t i = 0; i < 3; ++i) {
      const double g = 0.5 * gradient[i];
      m[i] = 0.9 * m[i] + 0.1 * g;
      v[i] = 0.999 * v[i] + 0.001 * g * g;
      p[i] -= 1e-2 * m[i] / (1 - std::pow(0.9, step)) /
              (std::sqrt(v[i] / (1 - std::pow(0.999, step))) + 1e-8);
      EXPECT_NEAR(parameters[i], p[i], 1e-5) << step;
    }
  }
}

}  // namespace
}  // namespace corridor::learner
