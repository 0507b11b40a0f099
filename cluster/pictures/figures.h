// Figures of curves over environment steps -> gnuplot's scripts. Pure.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cluster/results/training_curves.h"

namespace corridor::cluster {

// What one scenario's runs say about one quantity.
struct PlottedCurve {
  Curve raw;                    // thin
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
// for print.
std::string gnuplot_script(const Figure& figure, PictureFormat format);

}  // namespace corridor::cluster
