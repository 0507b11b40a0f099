// SPDX-License-Identifier: Apache-2.0
#include "replay/power.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "proto/base/failure.h"

namespace corridor::replay {
namespace {

constexpr int kMantissaBits = 23;
constexpr std::int32_t kExponentBias = 127;

// base = m * 2^e with m in [sqrt(1/2), sqrt(2)); log2 m by the series of the area tangent at
// s = (m - 1) / (m + 1), |s| < 0.172, whose first term left out is below 1e-9.
inline float log2_of(float base) {
  constexpr std::int32_t kRootOfHalf = 0x3f3504f3;
  const auto bits = std::bit_cast<std::int32_t>(base);
  const std::int32_t exponent = (bits - kRootOfHalf) >> kMantissaBits;
  const auto mantissa = std::bit_cast<float>(
      bits - static_cast<std::int32_t>(static_cast<std::uint32_t>(exponent) << kMantissaBits));
  constexpr float kTwoOverLn2 = 2.885390082F;
  const float s = (mantissa - 1.0F) / (mantissa + 1.0F);
  const float s2 = s * s;
  const float series = 1.0F + s2 * (1.0F / 3 + s2 * (1.0F / 5 + s2 * (1.0F / 7 + s2 * (1.0F / 9))));
  return static_cast<float>(exponent) + kTwoOverLn2 * s * series;
}

// 2^value = 2^n * e^(f ln 2) with f in [-1/2, 1/2], by Taylor's series.
inline float exp2_of(float value) {
  constexpr float kShift = 1024.5F;  // makes the cast round to nearest, below 0 too
  constexpr std::int32_t kShiftWhole = 1024;
  constexpr float kMost = 99.657F;  // 2^99.657 < 1e30
  value = std::min(std::max(value, -126.0F), kMost);
  const std::int32_t n = static_cast<std::int32_t>(value + kShift) - kShiftWhole;
  constexpr float kLn2 = 0.6931471806F;
  const float x = (value - static_cast<float>(n)) * kLn2;
  const float series =
      1.0F +
      x * (1.0F +
           x * (1.0F / 2 + x * (1.0F / 6 + x * (1.0F / 24 + x * (1.0F / 120 + x * (1.0F / 720))))));
  return series * std::bit_cast<float>((n + kExponentBias) << kMantissaBits);
}

}  // namespace

void power(std::span<const float> bases, float exponent, std::span<float> out) {
  CORRIDOR_CHECK(bases.size() == out.size() && std::abs(exponent) <= 8.0F,
                 "{} bases, {} powers, exponent {}", bases.size(), out.size(), exponent);
  const float* from = bases.data();
  float* to = out.data();
#pragma GCC ivdep
  for (std::size_t i = 0; i < bases.size(); ++i) to[i] = exp2_of(exponent * log2_of(from[i]));
}

}  // namespace corridor::replay
