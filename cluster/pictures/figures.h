// SPDX-License-Identifier: Apache-2.0
// Figures of curves over environment steps, drawn by gnuplot, of which it is the adapter.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "cluster/results/training_curves.h"

namespace corridor::cluster {

// What one scenario's runs say about one quantity.
struct PlottedCurve {
  Band raw;                     // thin, without a band
  Band trend;                   // thick, with a band from low to high
  std::optional<double> level;  // a horizontal line
};

struct Panel {
  std::string title;
  std::string unit;                  // of the y axis
  std::vector<PlottedCurve> curves;  // one a label; at least one of them is not empty
};

struct Figure {
  std::string name;  // of its files
  std::string caption;
  std::vector<std::string> labels;  // of the curves, the same in all panels
  std::string trend;                // what the thick lines are: "moving average"
  std::string level;                // what the horizontal lines are; may be empty
  bool points = false;              // the trend is of few values, each of which is marked
  std::vector<Panel> panels;        // side by side
};

enum class PictureFormat { kSvg, kPng };

// Draws the figure to standard output; the legend stands below the panels. PNG is twice as large,
// for print. Pure.
std::string gnuplot_script(const Figure& figure, PictureFormat format);

// What gnuplot writes to standard output for a script that sets a terminal and no output: the
// picture. The user's own gnuplot settings do not count. Throws Failure with gnuplot's reason in
// one line when it is not installed, refuses the script, or is not done by the deadline.
std::string run_gnuplot(const std::string& script,
                        std::chrono::milliseconds deadline = std::chrono::minutes(1));

}  // namespace corridor::cluster
