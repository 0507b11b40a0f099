// SPDX-License-Identifier: Apache-2.0
#include "replay/power.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace corridor::replay {
namespace {

TEST(Power, IsWithinItsErrorOverAllMagnitudes) {
  std::vector<float> bases;
  for (double base = 1.2e-38; base < 3e38; base *= 1.001) bases.push_back(static_cast<float>(base));
  std::vector<float> powers(bases.size());
  for (const float exponent : {0.0F, 0.4F, 0.6F, 0.9F, 1.0F, -1.0F}) {
    power(bases, exponent, powers);
    for (std::size_t i = 0; i < bases.size(); ++i) {
      const double exact = std::pow(static_cast<double>(bases[i]), static_cast<double>(exponent));
      if (exact < 1.2e-38) continue;
      if (exact > 9.9e29) {
        ASSERT_NEAR(powers[i], 9.95e29, 1e28) << bases[i] << '^' << exponent;
      } else {
        ASSERT_NEAR(powers[i], exact, 1e-5 * exact) << bases[i] << '^' << exponent;
      }
    }
  }
}

TEST(Power, OfOneIsOneAndNeverFalls) {
  std::vector<float> bases;
  for (int i = 0; i < 100'000; ++i) bases.push_back(0.5F + 1e-5F * static_cast<float>(i));
  std::vector<float> powers(bases.size());
  power(bases, 0.6F, powers);
  for (std::size_t i = 1; i < powers.size(); ++i) ASSERT_GE(powers[i], powers[i - 1] * 0.999999F);
  const std::vector<float> one{1.0F};
  std::vector<float> result(1);
  power(one, 0.4F, result);
  EXPECT_EQ(result[0], 1.0F);
}

}  // namespace
}  // namespace corridor::replay
