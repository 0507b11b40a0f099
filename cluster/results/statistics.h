// SPDX-License-Identifier: Apache-2.0
// 95 % confidence intervals for tables of results. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace corridor::cluster {

struct Interval {
  double low = 0.0;
  double high = 0.0;
  bool operator==(const Interval&) const = default;
};

// The exact interval (Garwood 1936) of the mean of a Poisson variable of which `count` was seen:
// at either end an outcome as extreme as `count` has probability 2.5 %.
// count >= 0; cost: about 100 * count exponentials.
Interval poisson_interval(std::int64_t count);

// The exact interval (Przyborowski and Wilenski 1940) of the ratio of two Poisson rates: `count`
// events were seen in `exposure`, independent of `other_count` in `other_exposure`. Given their
// sum, `count` is binomial, and its interval is that of Clopper and Pearson. The high end is
// infinite when other_count is 0. Counts >= 0, not both 0; exposures > 0.
Interval poisson_ratio_interval(std::int64_t count, double exposure, std::int64_t other_count,
                                double other_exposure);

// The mean of what is left without the lowest and the highest quarter of the values, rounded down
// to whole values: of 5 the middle 3, of 3 all. At least one value. It is scipy's
// trim_mean(values, 0.25), which rliable uses (Agarwal et al. 2021).
double interquartile_mean(std::span<const double> values);

// The bootstrap (Efron 1979): units are drawn with replacement, as many as there are, and the
// statistic is taken of them; `resamples` times. Draws are (seed, Purpose::kBootstrap, draw): the
// same input gives the same values, and all statistics of one seed see the same resamples. For two
// samples that are independent take two seeds.
inline constexpr int kResamples = 2000;
// Of sum(numerators) / sum(denominators). The spans are of equal length, at least 1; denominators
// are positive.
std::vector<double> bootstrap_ratios(std::span<const double> numerators,
                                     std::span<const double> denominators, std::uint64_t seed,
                                     int resamples = kResamples);
// Of the interquartile mean. At least one value.
std::vector<double> bootstrap_interquartile_means(std::span<const double> values,
                                                  std::uint64_t seed, int resamples = kResamples);

// Between the quantiles of a bootstrap's values: the percentile interval. At least one value.
// Few units make it too narrow (tests/cluster/results/statistics_test.cc).
Interval percentile_interval(std::vector<double> values);

}  // namespace corridor::cluster
