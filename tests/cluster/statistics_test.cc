#include "cluster/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "proto/random.h"

namespace corridor::cluster {
namespace {

TEST(PoissonInterval, AgreesWithPublishedTables) {
  const struct {
    std::int64_t count;
    double low, high;
  } published[] = {{0, 0.0, 3.689},   {1, 0.0253, 5.572},   {2, 0.2422, 7.225}, {10, 4.795, 18.39},
                   {85, 67.9, 105.1}, {100, 81.36, 121.63}, {141, 118.7, 166.3}};
  for (const auto& row : published) {
    const Interval interval = poisson_interval(row.count);
    EXPECT_NEAR(interval.low, row.low, 6e-4 * row.low + 1e-4) << row.count;
    EXPECT_NEAR(interval.high, row.high, 6e-4 * row.high) << row.count;
  }
}

TEST(PoissonInterval, StaysAccurateForLargeCounts) {
  // The normal approximation of the square root (Anscombe) is good to a few parts in 10^5 here.
  const Interval interval = poisson_interval(20'000);
  EXPECT_NEAR(interval.low, 20'000 - 1.96 * std::sqrt(20'000.0) + 1.0, 2.0);
  EXPECT_NEAR(interval.high, 20'000 + 1.96 * std::sqrt(20'000.0) + 2.0, 2.0);
}

TEST(PoissonInterval, WidensWithTheConfidence) {
  const Interval narrow = poisson_interval(7, 0.8), wide = poisson_interval(7, 0.99);
  EXPECT_LT(wide.low, narrow.low);
  EXPECT_GT(wide.high, narrow.high);
}

// `n` units whose value is uniform in [0, 1), all of size 1.
std::vector<double> uniform_units(std::size_t n, std::uint64_t seed) {
  std::vector<double> values(n);
  for (std::size_t i = 0; i < n; ++i) values[i] = random_unit(seed, Purpose::kTraffic, {i});
  return values;
}

TEST(BootstrapInterval, HasTheWidthOfTheNormalTheoryForAMean) {
  const std::vector<double> values = uniform_units(400, 1), ones(400, 1.0);
  const Interval interval = bootstrap_ratio_interval(values, ones, 5);
  const double expected = 2.0 * 1.96 * std::sqrt(1.0 / 12.0 / 400.0);
  EXPECT_NEAR(interval.high - interval.low, expected, 0.12 * expected);
}

TEST(BootstrapInterval, CoversTheTruthAboutAsOftenAsItSays) {
  int covered = 0;
  constexpr int kTrials = 300;
  const std::vector<double> ones(60, 1.0);
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto seed = static_cast<std::uint64_t>(trial);
    const Interval interval = bootstrap_ratio_interval(uniform_units(60, seed), ones, seed, 300);
    covered += interval.low <= 0.5 && 0.5 <= interval.high;
  }
  // 95 % of 300 is 285 with a deviation of 3.8; the percentile bootstrap falls a little short.
  EXPECT_GE(covered, 268);
  EXPECT_LE(covered, 298);
}

TEST(BootstrapInterval, WeighsUnitsByTheirDenominator) {
  // Every unit has the ratio 2, whatever its size: there is nothing to be uncertain about.
  const std::vector<double> sizes = {1.0, 10.0, 1000.0}, twice = {2.0, 20.0, 2000.0};
  const Interval interval = bootstrap_ratio_interval(twice, sizes, 1);
  EXPECT_DOUBLE_EQ(interval.low, 2.0);
  EXPECT_DOUBLE_EQ(interval.high, 2.0);
}

TEST(BootstrapInterval, IsTheSameForTheSameSeedAndAnotherForAnother) {
  const std::vector<double> values = uniform_units(30, 3), ones(30, 1.0);
  const Interval first = bootstrap_ratio_interval(values, ones, 1);
  const Interval again = bootstrap_ratio_interval(values, ones, 1);
  const Interval other = bootstrap_ratio_interval(values, ones, 2);
  EXPECT_EQ(first.low, again.low);
  EXPECT_EQ(first.high, again.high);
  EXPECT_NE(first.low, other.low);
}

}  // namespace
}  // namespace corridor::cluster
