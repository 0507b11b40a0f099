// SPDX-License-Identifier: Apache-2.0
#include "cluster/pictures/episode_figure.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cluster/pictures/chart.h"
#include "cluster/pictures/road_view.h"
#include "proto/base/format.h"
#include "proto/base/text.h"

namespace corridor::cluster {
namespace {

// Pixels.
constexpr double kWidth = 1140.0, kLeft = 150.0, kRight = 22.0;
constexpr double kTitle = 34.0, kLanesHeight = 110.0, kSpeedHeight = 110.0, kAxis = 52.0;
constexpr double kStripGap = 14.0, kTick = 5.0;

constexpr RoadView kRoad{.width = kWidth - kLeft - kRight,
                         .behind_m = 45.0,
                         .ahead_m = 45.0,
                         .hit_stands_out_before = true};

// 1, 2 or 5 times a power of ten, so that about `count` of them make up `range`.
double tick_step(double range, int count) {
  const double rough = range / count;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (rough <= step * power * 1.0001) return step * power;
  }
  return 10.0 * power;
}

// Below a box that is kRoad.width wide: `from` to `to`, ticks of which so many units a step.
void draw_axis(Canvas& canvas, double y, double from, double to, const std::string& title) {
  const double step = tick_step(to - from, 10);
  for (double at = std::ceil(from / step) * step; at <= to + 1e-9 * step; at += step) {
    const double x = kLeft + kRoad.width * (at - from) / (to - from);
    canvas.add(Line{{{x, y}, {x, y + kTick}}});
    canvas.add(Text{{x, y + 20}, 13, fmt::format("{:g}", at), Anchor::kMiddle});
  }
  canvas.add(Text{{kLeft + kRoad.width / 2, y + 40}, 13, title, Anchor::kMiddle});
}

void draw_lateral(Canvas& canvas, const EpisodeTrace& trace, const Chart& chart) {
  for (int line = 0; line <= trace.lanes; ++line) {
    const bool edge = line == 0 || line == trace.lanes;
    chart.level(canvas, line * trace.lane_width_m, {{}, kLine, edge ? 2.0 : 1.0, edge ? 0.0 : 6.0});
  }
  CurveValues d_m;
  for (const TracedStep& step : trace.steps) d_m.push_back(step.ego.d_m);
  chart.curve(canvas, d_m, trace.step_s, chart.end_s, {{}, kEgo, 1.6});
  for (int lane = 0; lane < trace.lanes; lane += std::max(1, trace.lanes - 1)) {
    const Point at = chart.at(0.0, (lane + 0.5) * trace.lane_width_m);
    canvas.add(
        Text{{at.x - 10, at.y + 5}, 13, lane == 0 ? "right lane" : "left lane", Anchor::kEnd});
  }
}

void draw_speed(Canvas& canvas, const EpisodeTrace& trace, const Chart& chart) {
  const double step_kph = tick_step(chart.highest, 6);
  for (double kph = 0.0; kph <= chart.highest; kph += step_kph) {
    const Point at = chart.at(0.0, kph);
    chart.level(canvas, kph, {{}, kGrid});
    canvas.add(Line{{{at.x - kTick, at.y}, at}});
    canvas.add(Text{{at.x - 10, at.y + 5}, 13, fmt::format("{:g}", kph), Anchor::kEnd});
  }
  chart.level(canvas, kKphPerMps * trace.speed_limit_mps, {{}, kInk, 1.0, 4.0});
  CurveValues kph;
  for (const TracedStep& step : trace.steps) kph.push_back(kKphPerMps * step.ego.speed_mps);
  chart.curve(canvas, kph, trace.step_s, chart.end_s, {{}, kEgo, 1.6});
  canvas.add(Line{{chart.at(0.0, chart.highest), chart.at(0.0, 0.0), chart.at(chart.end_s, 0.0)}});
  canvas.add(Text{{kLeft - 54, chart.top + chart.height / 2},
                  13,
                  "km/h",
                  Anchor::kMiddle,
                  kInk,
                  std::numbers::pi / 2});
}

// Returns where it ends.
double draw_typical(Canvas& canvas, const EpisodeTrace& trace, double top) {
  const double end_s = std::max(1.0, static_cast<double>(trace.steps.size() - 1)) * trace.step_s;
  const Chart lateral{kLeft,        top,   kRoad.width,
                      kLanesHeight, end_s, trace.lanes * trace.lane_width_m};
  draw_lateral(canvas, trace, lateral);
  const Chart speed{kLeft, top + kLanesHeight + kStripGap,          kRoad.width, kSpeedHeight,
                    end_s, 1.1 * kKphPerMps * trace.speed_limit_mps};
  draw_speed(canvas, trace, speed);
  draw_axis(canvas, speed.top + kSpeedHeight, 0.0, end_s, "time, s");
  return speed.top + kSpeedHeight + kAxis;
}

// Likewise.
double draw_failed(Canvas& canvas, const EpisodeTrace& trace, double top) {
  const std::size_t count = std::min(kShownInstants, trace.steps.size());
  const Clip clip{"", trace, 0.0, {}};
  for (std::size_t i = 0; i < count; ++i) {
    const double before_s = static_cast<double>(count - 1 - i) * trace.step_s;
    const TracedStep& step = trace.steps[trace.steps.size() - count + i];
    const Canvas road = road_from_above(clip, clip.duration_s() - before_s, kRoad);
    const std::string when = before_s == 0.0 ? "collision" : fmt::format("{:g} s before", before_s);
    canvas.add(Text{{kLeft - 14, top + 0.4 * road.height}, 13, when, Anchor::kEnd});
    if (step.command) {
      canvas.add(Text{{kLeft - 14, top + 0.4 * road.height + 24},
                      13,
                      "BP: " + trace.command_name(*step.command),
                      Anchor::kEnd,
                      kFaint});
    }
    canvas.inset({kLeft, top}, road);
    top += road.height + (i + 1 < count ? kStripGap : 0.0);
  }
  draw_axis(canvas, top, -kRoad.behind_m, kRoad.ahead_m, "m ahead of the ego");
  return top + kAxis;
}

}  // namespace

Canvas picture_of(const EpisodeFigure& figure) {
  Canvas canvas{kWidth};
  const auto title = [&](const char* what) {
    canvas.add(Text{{20, canvas.height + 24}, 18, figure.planner + what});
    return canvas.height + kTitle;
  };
  if (figure.typical) {
    canvas.height = draw_typical(canvas, figure.typical->trace, title(", a typical episode"));
  }
  if (figure.failed) {
    canvas.height = draw_failed(canvas, figure.failed->trace, title(", before a collision"));
  }
  return canvas;
}

std::string caption_of(const EpisodeFigure& figure) {
  std::string text = figure.planner + ".";
  if (figure.typical) {
    const EpisodeTrace& trace = figure.typical->trace;
    text += fmt::format(
        " A typical episode, the median in BP reward of those without collision ({}): BP reward "
        "{:.0f}, {} lane changes.",
        figure.typical->name, trace.bp_reward, trace.lane_changes);
  }
  if (figure.failed) {
    const EpisodeTrace& trace = figure.failed->trace;
    const std::string kind = trace.collision ? name_of(trace.collision->kind) : "";
    text += fmt::format(
        " Before a collision, the first with its seed ({}, {}): dark blue is the ego, red the "
        "other vehicle, the numbers are km/h; light blue and yellow are the corridors that the "
        "motion planner was shown and the one it chose, the line is its trajectory.",
        figure.failed->name, replaced(kind, '_', " "));
  }
  return text;
}

}  // namespace corridor::cluster
