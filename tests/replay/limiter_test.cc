// SPDX-License-Identifier: Apache-2.0
#include "replay/limiter.h"

#include <gtest/gtest.h>

#include "proto/base/random.h"

namespace corridor::replay {
namespace {

DqnSettings settings(std::int64_t minimum_size, double samples_per_insert, int batch_size) {
  DqnSettings result;
  result.minimum_size = minimum_size;
  result.samples_per_insert = samples_per_insert;
  result.batch_size = batch_size;
  return result;
}

TEST(LimiterTest, GrantsNothingBeforeTheMinimumAndNoBurstAtIt) {
  const DqnSettings dqn = settings(1000, 32.0, 64);
  EXPECT_EQ(granted_batches(dqn, 999), 0U);
  // Half a batch a row: the thousandth row is the first that counts.
  EXPECT_EQ(granted_batches(dqn, 1000), 0U);
  EXPECT_EQ(granted_batches(dqn, 1001), 1U);
  EXPECT_EQ(granted_batches(dqn, 1511), 256U);
}

TEST(LimiterTest, UnevenInsertsGiveExactlyTheAskedRatio) {
  const DqnSettings dqn = settings(5000, 32.0, 64);
  std::uint64_t inserted = 0;
  std::uint64_t granted = 0;
  for (std::uint64_t round = 0; round < 10'000; ++round) {
    inserted += random_below(700, 3, Purpose::kBootstrap, {round});
    const std::uint64_t total = granted_batches(dqn, inserted);
    ASSERT_GE(total, granted);
    granted = total;
    const std::uint64_t counted = inserted < 5000 ? 0 : inserted - 4999;
    ASSERT_EQ(granted, counted * 32 / 64) << "after round " << round;
  }
  EXPECT_GT(inserted, 3'000'000U);
}

TEST(LimiterTest, AFractionalRatioIsKeptInTheLongRun) {
  const DqnSettings dqn = settings(1, 0.7, 48);
  // The 48th row is the first that a whole batch can be drawn with.
  EXPECT_EQ(counted_rows(dqn, 7'000'047), 7'000'000U);
  EXPECT_NEAR(static_cast<double>(granted_batches(dqn, 7'000'047)) * 48 / 7e6, 0.7, 48 / 7e6);
}

TEST(LimiterTest, WaitsForAWholeBatchEvenIfTheMinimumIsSmaller) {
  const DqnSettings dqn = settings(0, 32.0, 64);
  EXPECT_EQ(granted_batches(dqn, 63), 0U);
  EXPECT_EQ(granted_batches(dqn, 65), 1U);
}

}  // namespace
}  // namespace corridor::replay
