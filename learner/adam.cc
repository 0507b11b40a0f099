// SPDX-License-Identifier: Apache-2.0
#include "learner/adam.h"

#include <array>
#include <cmath>
#include <cstddef>

#include "proto/base/failure.h"

namespace corridor::learner {

double norm(std::span<const float> values) {
  // So many sums side by side are a vector register.
  constexpr std::size_t kLanes = 16;
  std::array<float, kLanes> sums{};
  std::size_t i = 0;
  for (; i + kLanes <= values.size(); i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      sums[lane] += values[i + lane] * values[i + lane];
    }
  }
  double total = 0.0;
  for (const float sum : sums) total += sum;
  for (; i < values.size(); ++i) total += static_cast<double>(values[i]) * values[i];
  return std::sqrt(total);
}

void adam_step(std::span<float> parameters, std::span<const float> gradient, AdamMoments moments,
               float scale, double learning_rate, double epsilon, std::uint64_t step) {
  CORRIDOR_CHECK(gradient.size() == parameters.size() &&
                     moments.mean_gradient.size() == parameters.size() &&
                     moments.mean_squared_gradient.size() == parameters.size(),
                 "{} gradients for {} parameters", gradient.size(), parameters.size());
  constexpr double kBeta1 = 0.9;
  constexpr double kBeta2 = 0.999;
  const auto t = static_cast<double>(step);
  const auto step_size = static_cast<float>(learning_rate / (1.0 - std::pow(kBeta1, t)));
  const auto per_root_of_correction =
      static_cast<float>(1.0 / std::sqrt(1.0 - std::pow(kBeta2, t)));
  constexpr auto kBeta1f = static_cast<float>(kBeta1);
  constexpr auto kBeta2f = static_cast<float>(kBeta2);
  constexpr auto kNew1 = static_cast<float>(1.0 - kBeta1);
  constexpr auto kNew2 = static_cast<float>(1.0 - kBeta2);
  const auto small = static_cast<float>(epsilon);
  float* const p = parameters.data();
  const float* const g = gradient.data();
  float* const m = moments.mean_gradient.data();
  float* const v = moments.mean_squared_gradient.data();
#pragma GCC ivdep
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const float scaled = scale * g[i];
    m[i] = kBeta1f * m[i] + kNew1 * scaled;
    v[i] = kBeta2f * v[i] + kNew2 * scaled * scaled;
    p[i] -= step_size * (m[i] / (std::sqrt(v[i]) * per_root_of_correction + small));
  }
}

}  // namespace corridor::learner
