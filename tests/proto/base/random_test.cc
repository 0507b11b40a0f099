// SPDX-License-Identifier: Apache-2.0
#include "proto/base/random.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <set>
#include <vector>

namespace corridor {
namespace {

// Pearson's statistic of equally likely cells, as a normal deviate (for many cells).
double deviation(const std::vector<int>& counts) {
  double total = 0;
  for (const int count : counts) total += count;
  const double expected = total / static_cast<double>(counts.size());
  double chi_square = 0;
  for (const int count : counts) chi_square += (count - expected) * (count - expected) / expected;
  const double degrees = static_cast<double>(counts.size()) - 1;
  return (chi_square - degrees) / std::sqrt(2 * degrees);
}

TEST(Random, NumbersStayAsTheyAre) {
  // Recorded results depend on them.
  EXPECT_EQ(random_bits(0, Purpose::kInitialWeights, {}), 4964578127960768432ULL);
  EXPECT_EQ(random_bits(1, Purpose::kExploration, {0, 1, 2, 3}), 12519117125012822446ULL);
  EXPECT_EQ(random_bits(~0ULL, Purpose::kReplaySampling, {1, ~0ULL}), 5658871520205803954ULL);
  EXPECT_EQ(random_unit(7, Purpose::kTraffic, {5, 6, 7}), 0x1.82a1621278f22p-2);
  EXPECT_EQ(random_below(1000, 7, Purpose::kSumo, {}), 361U);
}

TEST(Random, UnitsAreUniformOverACounter) {
  std::vector<int> counts(1000);
  double sum = 0;
  for (std::uint64_t i = 0; i < 200'000; ++i) {
    const double unit = random_unit(1, Purpose::kReplaySampling, {0, i});
    ASSERT_GE(unit, 0.0);
    ASSERT_LT(unit, 1.0);
    sum += unit;
    ++counts[static_cast<std::size_t>(unit * 1000)];
  }
  EXPECT_NEAR(sum / 200'000, 0.5, 4 * std::sqrt(1.0 / 12 / 200'000));
  EXPECT_LT(std::abs(deviation(counts)), 4.0);
}

TEST(Random, UnitsAreUniformOverSeedsAndOverEveryIndex) {
  for (int varied = 0; varied < 4; ++varied) {
    std::vector<int> counts(500);
    for (std::uint64_t i = 0; i < 100'000; ++i) {
      const std::uint64_t at[4] = {varied == 0 ? i : 3, varied == 1 ? i : 0, varied == 2 ? i : 0,
                                   varied == 3 ? i : 0};
      ++counts[random_below(500, at[0], Purpose::kTraffic, {at[1], at[2], at[3]})];
    }
    EXPECT_LT(std::abs(deviation(counts)), 4.0) << varied;
  }
}

TEST(Random, SuccessiveDrawsAreIndependent) {
  std::vector<int> pairs(32 * 32);
  const auto draw = [](std::uint64_t i) {
    return random_below(32, 9, Purpose::kExploration, {0, 0, 4, i});
  };
  for (std::uint64_t i = 0; i < 100'000; ++i) ++pairs[draw(2 * i) * 32 + draw(2 * i + 1)];
  EXPECT_LT(std::abs(deviation(pairs)), 4.0);
}

TEST(Random, PurposesAreIndependent) {
  std::vector<int> pairs(32 * 32);
  for (std::uint64_t i = 0; i < 100'000; ++i) {
    ++pairs[random_below(32, 1, Purpose::kExploration, {i}) * 32 +
            random_below(32, 1, Purpose::kRandomBp, {i})];
  }
  EXPECT_LT(std::abs(deviation(pairs)), 4.0);
}

TEST(Random, OneChangedBitChangesHalfOfTheResult) {
  double changed = 0;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    for (int bit = 0; bit < 64; ++bit) {
      changed += std::popcount(random_bits(i, Purpose::kSumo, {5}) ^
                               random_bits(i ^ (1ULL << bit), Purpose::kSumo, {5}));
      changed += std::popcount(random_bits(5, Purpose::kSumo, {i}) ^
                               random_bits(5, Purpose::kSumo, {i ^ (1ULL << bit)}));
    }
  }
  EXPECT_NEAR(changed / (2 * 64 * 1000), 32.0, 0.1);
}

TEST(Random, IndicesOfAnotherOrderOrNumberAreOtherDraws) {
  std::set<std::uint64_t> seen;
  std::size_t draws = 0;
  const auto see = [&](std::uint64_t bits) {
    seen.insert(bits);
    ++draws;
  };
  see(random_bits(1, Purpose::kSumo, {}));
  for (std::uint64_t i = 0; i < 50; ++i) {
    see(random_bits(1, Purpose::kSumo, {i}));
    for (std::uint64_t j = 0; j < 50; ++j) {
      see(random_bits(1, Purpose::kSumo, {i, j}));
      see(random_bits(1, Purpose::kSumo, {i, j, 0}));
    }
  }
  EXPECT_EQ(seen.size(), draws);
}

TEST(Random, ASequenceHasTheNumbersOfItsIndices) {
  const RandomSequence sequence(7, Purpose::kTraffic, {3, 4});
  const RandomSequence short_one(7, Purpose::kTraffic, {});
  for (std::uint64_t i = 0; i < 100; ++i) {
    EXPECT_EQ(sequence.unit(i), random_unit(7, Purpose::kTraffic, {3, 4, i}));
    EXPECT_EQ(short_one.unit(i), random_unit(7, Purpose::kTraffic, {i}));
  }
}

TEST(Random, BelowStaysBelow) {
  for (const std::uint64_t bound : {1ULL, 2ULL, 3ULL, 1ULL << 63, ~0ULL}) {
    for (std::uint64_t i = 0; i < 1000; ++i) {
      EXPECT_LT(random_below(bound, 1, Purpose::kBootstrap, {i}), bound);
    }
  }
}

}  // namespace
}  // namespace corridor
