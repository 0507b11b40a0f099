// SPDX-License-Identifier: Apache-2.0
#include "cluster/results/statistics.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "proto/base/failure.h"
#include "proto/base/random.h"

namespace corridor::cluster {
namespace {

constexpr double kTail = 0.5 * (1.0 - 0.95);  // at either end of an interval

// P(X <= count) for X of mean `mean`. Each term comes from its logarithm: a recurrence from either
// end of the sum would start from an underflow when mean and count are far apart.
double poisson_cdf(std::int64_t count, double mean) {
  if (mean <= 0.0) return 1.0;
  double sum = 0.0;
  for (std::int64_t k = 0; k <= count; ++k) {
    const auto x = static_cast<double>(k);
    sum += std::exp(x * std::log(mean) - mean - std::lgamma(x + 1.0));
  }
  return sum;
}

// P(X <= count) for X of `trials` trials that succeed with `probability`, in (0, 1).
double binomial_cdf(std::int64_t count, std::int64_t trials, double probability) {
  const auto n = static_cast<double>(trials);
  double sum = 0.0;
  for (std::int64_t k = 0; k <= count; ++k) {
    const auto x = static_cast<double>(k);
    sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(x + 1.0) - std::lgamma(n - x + 1.0) +
                    x * std::log(probability) + (n - x) * std::log1p(-probability));
  }
  return sum;
}

// Where in [low, high] a falling function has that value.
template <typename Falling>
double inverse(const Falling& function, double value, double low, double high) {
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (function(middle) > value ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// Linear interpolation between order statistics (Hyndman and Fan's type 7).
double quantile(const std::vector<double>& sorted, double probability) {
  const double position = probability * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], position - static_cast<double>(below));
}

}  // namespace

Interval poisson_interval(std::int64_t count) {
  CORRIDOR_CHECK(count >= 0, "{}", count);
  // P(X <= most), by the mean.
  const auto cdf_of = [](std::int64_t most) {
    return [most](double mean) { return poisson_cdf(most, mean); };
  };
  const auto seen = static_cast<double>(count);
  // Beyond every upper end (ten deviations and a constant).
  const double largest = seen + 10.0 * std::sqrt(seen) + 50.0;
  return {count == 0 ? 0.0 : inverse(cdf_of(count - 1), 1.0 - kTail, 0.0, seen),
          inverse(cdf_of(count), kTail, seen, largest)};
}

Interval poisson_ratio_interval(std::int64_t count, double exposure, std::int64_t other_count,
                                double other_exposure) {
  const std::int64_t both = count + other_count;
  CORRIDOR_CHECK(
      count >= 0 && other_count >= 0 && both > 0 && exposure > 0.0 && other_exposure > 0.0,
      "{} in {}, {} in {}", count, exposure, other_count, other_exposure);
  const auto cdf_of = [both](std::int64_t most) {
    return [=](double probability) { return binomial_cdf(most, both, probability); };
  };
  const double low = count == 0 ? 0.0 : inverse(cdf_of(count - 1), 1.0 - kTail, 0.0, 1.0);
  const double high = other_count == 0 ? 1.0 : inverse(cdf_of(count), kTail, 0.0, 1.0);
  const auto ratio = [&](double share) {
    return share / (1.0 - share) * other_exposure / exposure;
  };
  return {ratio(low), ratio(high)};
}

double interquartile_mean(std::span<const double> values) {
  CORRIDOR_CHECK(!values.empty(), "a mean of no values");
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  const std::size_t cut = sorted.size() / 4;
  double sum = 0.0;
  for (std::size_t i = cut; i < sorted.size() - cut; ++i) sum += sorted[i];
  return sum / static_cast<double>(sorted.size() - 2 * cut);
}

std::vector<double> bootstrap_ratios(std::span<const double> numerators,
                                     std::span<const double> denominators, std::uint64_t seed,
                                     int resamples) {
  CORRIDOR_CHECK(!numerators.empty() && numerators.size() == denominators.size() && resamples > 0,
                 "{} numerators, {} denominators", numerators.size(), denominators.size());
  std::vector<double> ratios(static_cast<std::size_t>(resamples));
  std::uint64_t draw = 0;
  for (double& ratio : ratios) {
    double numerator = 0.0;
    double denominator = 0.0;
    for (std::size_t unit = 0; unit < numerators.size(); ++unit) {
      const std::uint64_t drawn =
          random_below(numerators.size(), seed, Purpose::kBootstrap, {draw++});
      numerator += numerators[drawn];
      denominator += denominators[drawn];
    }
    ratio = numerator / denominator;
  }
  return ratios;
}

std::vector<double> bootstrap_interquartile_means(std::span<const double> values,
                                                  std::uint64_t seed, int resamples) {
  CORRIDOR_CHECK(!values.empty() && resamples > 0, "{} values", values.size());
  std::vector<double> means(static_cast<std::size_t>(resamples));
  std::vector<double> drawn(values.size());
  std::uint64_t draw = 0;
  for (double& mean : means) {
    for (double& value : drawn) {
      value = values[random_below(values.size(), seed, Purpose::kBootstrap, {draw++})];
    }
    mean = interquartile_mean(drawn);
  }
  return means;
}

Interval percentile_interval(std::vector<double> values) {
  CORRIDOR_CHECK(!values.empty(), "of no values");
  std::sort(values.begin(), values.end());
  return {quantile(values, kTail), quantile(values, 1.0 - kTail)};
}

}  // namespace corridor::cluster
