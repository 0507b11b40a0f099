// SPDX-License-Identifier: Apache-2.0
// Curves over time in a box of a canvas. Pure.
#pragma once

#include <optional>
#include <vector>

#include "cluster/pictures/canvas.h"

namespace corridor::cluster {

using CurveValues = std::vector<std::optional<double>>;  // a gap where there is none

// The lower left corner stands for 0, 0.
struct Chart {
  double left = 0.0, top = 0.0, width = 0.0, height = 0.0;  // pixels
  double end_s = 1.0;                                       // at the right edge
  double highest = 1.0;                                     // at the upper edge

  Point at(double time_s, double value) const;
  // `values` are `every_s` apart from 0 on; those after `until_s` do not show.
  void curve(Canvas& canvas, const CurveValues& values, double every_s, double until_s,
             const Line& style) const;
  // A horizontal line.
  void level(Canvas& canvas, double value, const Line& style) const;
};

}  // namespace corridor::cluster
