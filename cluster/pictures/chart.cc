// SPDX-License-Identifier: Apache-2.0
#include "cluster/pictures/chart.h"

#include <utility>

namespace corridor::cluster {

Point Chart::at(double time_s, double value) const {
  return {left + width * time_s / end_s, top + height * (1.0 - value / highest)};
}

void Chart::curve(Canvas& canvas, const CurveValues& values, double every_s, double until_s,
                  const Line& style) const {
  Line line = style;
  const auto end = [&] {
    if (!line.points.empty()) canvas.add(std::exchange(line, style));
  };
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double time_s = static_cast<double>(i) * every_s;
    if (time_s > until_s + 1e-9) break;
    if (values[i]) {
      line.points.push_back(at(time_s, *values[i]));
    } else {
      end();
    }
  }
  end();
}

void Chart::level(Canvas& canvas, double value, const Line& style) const {
  Line line = style;
  line.points = {at(0.0, value), at(end_s, value)};
  canvas.add(std::move(line));
}

}  // namespace corridor::cluster
