// SPDX-License-Identifier: Apache-2.0
// Pearson's test of whether draws follow known probabilities.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace corridor::replay {

// Sums up independent multinomial experiments.
class ChiSquare {
 public:
  // `counts` of draws[i] that fell into cell i of probability[i] (of this experiment; sum 1). Cells
  // that expect fewer than 5 draws are taken together, as the statistic's law needs.
  void add(const std::vector<double>& probabilities, const std::vector<std::size_t>& counts) {
    std::size_t draws = 0;
    for (const std::size_t count : counts) draws += count;
    double rest_expected = 0.0;
    double rest_count = 0.0;
    std::size_t cells = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const double expected = probabilities[i] * static_cast<double>(draws);
      const auto count = static_cast<double>(counts[i]);
      if (expected < 5.0) {
        rest_expected += expected;
        rest_count += count;
      } else {
        add_cell(expected, count);
        ++cells;
      }
    }
    if (rest_expected >= 5.0) {
      add_cell(rest_expected, rest_count);
      ++cells;
    }
    if (cells > 1) degrees_ += static_cast<double>(cells - 1);
  }

  double degrees() const { return degrees_; }

  // The probability of a statistic as large, by Wilson and Hilferty's (1931) normal approximation;
  // good to 1e-3 from 30 degrees of freedom on.
  double p_value() const {
    const double spread = 2.0 / (9.0 * degrees_);
    const double normal = (std::cbrt(statistic_ / degrees_) - (1.0 - spread)) / std::sqrt(spread);
    return 0.5 * std::erfc(normal / std::sqrt(2.0));
  }

 private:
  void add_cell(double expected, double count) {
    statistic_ += (count - expected) * (count - expected) / expected;
  }

  double statistic_ = 0.0;
  double degrees_ = 0.0;
};

}  // namespace corridor::replay
