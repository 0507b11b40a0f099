// SPDX-License-Identifier: Apache-2.0
#include "cluster/pictures/figures.h"

#include <algorithm>
#include <cstring>
#include <set>

#include "cluster/pictures/palette.h"
#include "proto/base/failure.h"
#include "proto/base/text.h"
#include "proto/system/subprocess.h"

namespace corridor::cluster {
namespace {

constexpr int kPanelWidth = 380, kHeight = 350;  // pixels

Colour colour(std::size_t curve) { return kCurves[curve % kCurves.size()]; }

// Text, as gnuplot takes it as it is: in single quotes, since in double ones it runs `commands`.
std::string literal(const std::string& text) {
  return "'" + replaced(replaced(text, '\'', "''"), '\n', " ") + "'";
}

std::string terminal_script(const std::string& name, int width, PictureFormat format) {
  if (format == PictureFormat::kSvg) {
    return fmt::format(
        "set terminal svg size {},{} dynamic name {} font 'Helvetica,Arial,sans-serif,13'\n", width,
        kHeight, literal(name));
  }
  return fmt::format("set terminal pngcairo size {},{} font 'sans,10' fontscale 2 linewidth 2\n",
                     2 * width, 2 * kHeight);
}

// The curves of one panel as data blocks: thousands of steps, mean, low, high.
std::string data_blocks(const Panel& panel, std::size_t number) {
  std::string text;
  const auto add = [&](const char* name, std::size_t curve, const Band& band) {
    text += fmt::format("${}_{}_{} << EOD\n", name, number, curve);
    for (const auto& [step, mean, low, high] : band) {
      text += fmt::format("{} {:.6g} {:.6g} {:.6g}\n", static_cast<double>(step) / 1000.0, mean,
                          low, high);
    }
    text += "EOD\n";
  };
  for (std::size_t i = 0; i < panel.curves.size(); ++i) {
    add("raw", i, panel.curves[i].raw);
    add("trend", i, panel.curves[i].trend);
  }
  return text;
}

bool has_band(const Band& band) {
  return std::ranges::any_of(band, [](const auto& point) { return point.low < point.high; });
}

// Of one curve its lines are named, of several the curves: the caption says what the lines are.
std::string legend(const Figure& figure, std::size_t curve, const std::string& line) {
  if (figure.labels.size() == 1) return line;
  if (line == figure.trend) return figure.labels[curve];
  return line == figure.level ? figure.labels[curve] + ", " + line : "";
}

// What is plotted, and what the legend says of it.
struct Plot {
  std::string data;   // with `using`; a number for a horizontal line
  std::string style;  // from `with` on
  std::string title;  // empty: the legend does not say it
};

// Bands lie lowest, then the thin lines, then the thick ones.
std::vector<Plot> plots_of(const Figure& figure, const Panel& panel, std::size_t number) {
  std::vector<Plot> bands, raw, trends, levels;
  for (std::size_t i = 0; i < panel.curves.size(); ++i) {
    const PlottedCurve& curve = panel.curves[i];
    const std::string trend = fmt::format("$trend_{}_{}", number, i);
    if (has_band(curve.trend)) {
      bands.push_back({trend + " using 1:3:4",
                       fmt::format("filledcurves fc rgb '{}' fs transparent solid 0.25 noborder",
                                   hexadecimal(colour(i))),
                       legend(figure, i, "lowest to highest")});
    }
    if (!curve.raw.empty()) {
      raw.push_back({fmt::format("$raw_{}_{} using 1:2", number, i),
                     fmt::format("lines lw 0.7 lc rgb '#a0{:06x}'", colour(i)),
                     legend(figure, i, "as measured")});
    }
    if (!curve.trend.empty()) {
      trends.push_back(
          {trend + " using 1:2",
           fmt::format("{} lw 2.2 lc rgb '{}'", figure.points ? "linespoints pt 7 ps 0.6" : "lines",
                       hexadecimal(colour(i))),
           legend(figure, i, figure.trend)});
    }
    if (curve.level) {
      levels.push_back({fmt::format("{:.6g}", *curve.level),
                        fmt::format("lines lw 1.6 dt (8,5) lc rgb '{}'",
                                    hexadecimal(figure.labels.size() == 1 ? kInk : colour(i))),
                        legend(figure, i, figure.level)});
    }
  }
  std::vector<Plot> plots;
  for (const auto& layer : {bands, raw, trends, levels}) {
    plots.insert(plots.end(), layer.begin(), layer.end());
  }
  return plots;
}

std::string plot_command(const std::vector<std::string>& items) {
  return fmt::format("plot {}\n", listed(items, ", \\\n  "));
}

std::string panel_script(const Figure& figure, std::size_t number) {
  const Panel& panel = figure.panels[number];
  std::vector<std::string> items;
  for (const Plot& plot : plots_of(figure, panel, number)) {
    items.push_back(plot.data + " with " + plot.style + " notitle");
  }
  return fmt::format("set title {} textcolor rgb '{}'\n", literal(panel.title), hexadecimal(kInk)) +
         fmt::format("set ylabel {} textcolor rgb '{}' offset 0.5,0\n", literal(panel.unit),
                     hexadecimal(kInk)) +
         plot_command(items);
}

// A plot of nothing over the whole width: a panel's own legend would be as wide as the panel. What
// would only say that there is one line is left out.
std::string legend_script(const Figure& figure) {
  std::vector<std::string> items;
  std::set<std::string> titles;
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    for (const Plot& plot : plots_of(figure, figure.panels[i], i)) {
      if (plot.title.empty() || !titles.insert(plot.title).second) continue;
      items.push_back("NaN with " + plot.style + " title " + literal(plot.title));
    }
  }
  if (items.size() < 2) return "";
  return "set lmargin at screen 0\nset rmargin at screen 1\n"
         "set bmargin at screen 0\nset tmargin at screen 0.1\n"
         "unset border\nunset tics\nunset grid\nunset title\nunset xlabel\nunset ylabel\n"
         "set xrange [0:1]\nset yrange [0:1]\n" +
         fmt::format(
             "set key center center horizontal Left reverse samplen 2.5 textcolor rgb '{}'\n",
             hexadecimal(kInk)) +
         plot_command(items);
}

// gnuplot says the line, then marks the place, then says what is wrong.
std::string last_line(std::string text) {
  text.erase(text.find_last_not_of(" \n") + 1);
  text.erase(0, text.rfind('\n') + 1);
  text.erase(0, text.find_first_not_of(' '));
  return text;
}

}  // namespace

std::string gnuplot_script(const Figure& figure, PictureFormat format) {
  const int width = kPanelWidth * static_cast<int>(figure.panels.size());
  std::string script = terminal_script(figure.name, width, format);
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    script += data_blocks(figure.panels[i], i);
  }
  const auto panels = static_cast<double>(figure.panels.size());
  script += fmt::format(
      "set termoption noenhanced\n"
      "set border 3 lc rgb '{0}'\n"
      "set tics nomirror out scale 0.6 textcolor rgb '{0}'\n"
      "set grid ytics lt 1 lc rgb '{1}' lw 0.7\n"
      "set xlabel 'environment steps, thousands' textcolor rgb '{0}'\n"
      "set xrange [0:*] noextend\n"
      "set yrange [*<0:*]\n"
      "set multiplot layout 1,{2} margins {3:.4f},{4:.4f},0.29,0.88 spacing {5:.4f},0\n",
      hexadecimal(kInk), hexadecimal(kGrid), figure.panels.size(), 0.24 / panels,
      1.0 - 0.06 / panels, 0.28 / panels);
  for (std::size_t i = 0; i < figure.panels.size(); ++i) script += panel_script(figure, i);
  return script + legend_script(figure) + "unset multiplot\n";
}

std::string run_gnuplot(const std::string& script, std::chrono::milliseconds deadline) {
  const auto program = find_program("gnuplot");
  if (!program) {
    throw Failure("gnuplot is not installed, and it draws the figures: install gnuplot-nox");
  }
  const auto result = run_subprocess(*program, {"--default-settings"}, script, deadline);
  if (!result) {
    throw Failure("gnuplot was not done within {} s and was killed",
                  std::chrono::duration<double>(deadline).count());
  }
  if (result->status > 128) {
    throw Failure("gnuplot ended with signal {}", strsignal(result->status - 128));
  }
  if (result->status != 0 || result->output.empty()) {
    throw Failure("gnuplot drew nothing: {}", last_line(result->errors));
  }
  return result->output;
}

}  // namespace corridor::cluster
