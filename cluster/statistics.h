// Confidence intervals for the evaluation table. Pure.
#pragma once

#include <cstdint>
#include <span>

namespace corridor::cluster {

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

// The exact interval (Garwood 1936) of the mean of a Poisson variable of which `count` was seen:
// at either end an outcome as extreme as `count` has probability (1 - confidence) / 2.
// count >= 0; cost: about 100 * count exponentials.
Interval poisson_interval(std::int64_t count, double confidence = 0.95);

// The percentile bootstrap (Efron 1979) of sum(numerators) / sum(denominators): units (episodes)
// are drawn with replacement, `resamples` times. The spans are of equal length, at least 1;
// denominators are positive. Draws are (seed, Purpose::kBootstrap, draw): the same input gives the
// same interval, and all statistics of one seed see the same resamples.
Interval bootstrap_ratio_interval(std::span<const double> numerators,
                                  std::span<const double> denominators, std::uint64_t seed,
                                  int resamples = 2000, double confidence = 0.95);

}  // namespace corridor::cluster
