// SPDX-License-Identifier: Apache-2.0
#include "cluster/results/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "proto/base/random.h"

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

// poisson.test of R 4 and its documentation's example: 11 in 800 against 21 in 3011 person years.
TEST(PoissonRatioInterval, AgreesWithR) {
  const Interval interval = poisson_ratio_interval(11, 800.0, 21, 3011.0);
  EXPECT_NEAR(interval.low, 0.8584264, 1e-6);
  EXPECT_NEAR(interval.high, 4.2772659, 1e-6);
}

TEST(PoissonRatioInterval, IsThatOfClopperAndPearsonAndTurnsOverWithItsArguments) {
  // No success in 10 trials: at most 1 - 0.025^(1/10) = 0.30850 each.
  const Interval none = poisson_ratio_interval(0, 1.0, 10, 1.0);
  EXPECT_EQ(none.low, 0.0);
  EXPECT_NEAR(none.high, 0.30850 / (1.0 - 0.30850), 1e-4);
  const Interval all = poisson_ratio_interval(10, 1.0, 0, 1.0);
  EXPECT_NEAR(all.low, 1.0 / none.high, 1e-9);
  EXPECT_TRUE(std::isinf(all.high));
  const Interval ahead = poisson_ratio_interval(130, 120.0, 170, 40.0);
  const Interval behind = poisson_ratio_interval(170, 40.0, 130, 120.0);
  EXPECT_NEAR(ahead.low, 1.0 / behind.high, 1e-9);
  EXPECT_NEAR(ahead.high, 1.0 / behind.low, 1e-9);
}

TEST(InterquartileMean, LeavesOutTheQuartersAtBothEndsRoundedDown) {
  EXPECT_EQ(interquartile_mean(std::vector{7.0}), 7.0);
  EXPECT_EQ(interquartile_mean(std::vector{9.0, 0.0, 3.0}), 4.0);
  EXPECT_EQ(interquartile_mean(std::vector{1000.0, 2.0, 1.0, 3.0}), 2.5);
  EXPECT_EQ(interquartile_mean(std::vector{-1000.0, 4.0, 2.0, 1000.0, 3.0}), 3.0);
  EXPECT_EQ(interquartile_mean(std::vector{8.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0}), 4.5);
}

// `n` units whose value is uniform in [0, 1), all of size 1.
std::vector<double> uniform_units(std::size_t n, std::uint64_t seed) {
  std::vector<double> values(n);
  for (std::size_t i = 0; i < n; ++i) values[i] = random_unit(seed, Purpose::kTraffic, {i});
  return values;
}

Interval ratio_interval(const std::vector<double>& numerators,
                        const std::vector<double>& denominators, std::uint64_t seed,
                        int resamples = kResamples) {
  return percentile_interval(bootstrap_ratios(numerators, denominators, seed, resamples));
}

TEST(PercentileInterval, InterpolatesBetweenTheSortedValues) {
  std::vector<double> values;
  for (int i = 1000; i >= 0; --i) values.push_back(i);
  EXPECT_NEAR(percentile_interval(values).low, 25.0, 1e-9);
  EXPECT_NEAR(percentile_interval(values).high, 975.0, 1e-9);
  EXPECT_EQ(percentile_interval({3.0}), (Interval{3.0, 3.0}));
}

TEST(BootstrapInterval, HasTheWidthOfTheNormalTheoryForAMean) {
  const std::vector<double> values = uniform_units(400, 1), ones(400, 1.0);
  const Interval interval = ratio_interval(values, ones, 5);
  const double expected = 2.0 * 1.96 * std::sqrt(1.0 / 12.0 / 400.0);
  EXPECT_NEAR(interval.high - interval.low, expected, 0.12 * expected);
}

TEST(BootstrapInterval, CoversTheTruthAboutAsOftenAsItSays) {
  int covered = 0;
  constexpr int kTrials = 300;
  const std::vector<double> ones(60, 1.0);
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto seed = static_cast<std::uint64_t>(trial);
    const Interval interval = ratio_interval(uniform_units(60, seed), ones, seed, 300);
    covered += interval.low <= 0.5 && 0.5 <= interval.high;
  }
  // 95 % of 300 is 285 with a deviation of 3.8; the percentile bootstrap falls a little short.
  EXPECT_GE(covered, 268);
  EXPECT_LE(covered, 298);
}

TEST(BootstrapInterval, WeighsUnitsByTheirDenominator) {
  // Every unit has the ratio 2, whatever its size: there is nothing to be uncertain about.
  const std::vector<double> sizes = {1.0, 10.0, 1000.0}, twice = {2.0, 20.0, 2000.0};
  const Interval interval = ratio_interval(twice, sizes, 1);
  EXPECT_DOUBLE_EQ(interval.low, 2.0);
  EXPECT_DOUBLE_EQ(interval.high, 2.0);
}

TEST(BootstrapInterval, IsTheSameForTheSameSeedAndAnotherForAnother) {
  const std::vector<double> values = uniform_units(30, 3), ones(30, 1.0);
  const Interval first = ratio_interval(values, ones, 1);
  const Interval again = ratio_interval(values, ones, 1);
  const Interval other = ratio_interval(values, ones, 2);
  EXPECT_EQ(first.low, again.low);
  EXPECT_EQ(first.high, again.high);
  EXPECT_NE(first.low, other.low);
}

// Box and Muller's.
double normal(std::uint64_t trial, std::uint64_t index) {
  const double radius =
      std::sqrt(-2.0 * std::log1p(-random_unit(trial, Purpose::kTraffic, {index, 0})));
  return radius *
         std::cos(2.0 * std::numbers::pi * random_unit(trial, Purpose::kTraffic, {index, 1}));
}

// How often the 95 % interval of the interquartile mean of `n` normal values holds the truth, 0.
double coverage(std::size_t n) {
  constexpr int kTrials = 1000;
  int covered = 0;
  std::vector<double> values(n);
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    for (std::size_t i = 0; i < n; ++i) values[i] = normal(trial, i);
    const Interval interval =
        percentile_interval(bootstrap_interquartile_means(values, trial, 400));
    covered += interval.low <= 0.0 && 0.0 <= interval.high;
  }
  return static_cast<double>(covered) / kTrials;
}

TEST(BootstrapOfInterquartileMeans, CoversTheTruthTooSeldomForFiveValuesAndAboutAsItSaysForForty) {
  EXPECT_NEAR(coverage(5), 0.90, 0.03);
  EXPECT_NEAR(coverage(40), 0.94, 0.02);
}

TEST(BootstrapOfInterquartileMeans, IsTheSameForTheSameSeedAndAnotherForAnother) {
  const std::vector<double> values = uniform_units(5, 3);
  EXPECT_EQ(bootstrap_interquartile_means(values, 1), bootstrap_interquartile_means(values, 1));
  EXPECT_NE(bootstrap_interquartile_means(values, 1), bootstrap_interquartile_means(values, 2));
}

}  // namespace
}  // namespace corridor::cluster
