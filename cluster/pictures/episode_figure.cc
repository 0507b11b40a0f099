#include "cluster/pictures/episode_figure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "proto/base/format.h"

namespace corridor::cluster {
namespace {

// Pixels, from the top.
constexpr int kWidth = 1140, kLeft = 150, kRight = 20;
constexpr int kTitle = 34, kLanesHeight = 110, kSpeedHeight = 110, kAxis = 52, kStripGap = 14;

constexpr double kBehind_m = 45.0, kAhead_m = 45.0;  // of the ego's front bumper
constexpr double kKphPerMps = 3.6;
constexpr std::array kCommands = {"keep", "left", "right"};

int strip_height(const EpisodeTrace& trace) {
  const double pixels_per_m = (kWidth - kLeft - kRight) / (kBehind_m + kAhead_m);
  return static_cast<int>(std::lround(trace.lanes * trace.lane_width_m * pixels_per_m));
}

std::size_t instants(const EpisodeTrace& trace) {
  return std::min(kShownInstants, trace.steps.size());
}

// A plot between two heights.
class Page {
 public:
  explicit Page(int height) : height_(height) {}

  std::string at(int top, int bottom) const {
    return fmt::format(
        "set lmargin at screen {:.4f}\nset rmargin at screen {:.4f}\n"
        "set tmargin at screen {:.4f}\nset bmargin at screen {:.4f}\n",
        1.0 * kLeft / kWidth, 1.0 - 1.0 * kRight / kWidth, 1.0 - 1.0 * top / height_,
        1.0 - 1.0 * bottom / height_);
  }

  std::string title(int bottom, const std::string& text) const {
    return fmt::format("set label 1 {} at screen {:.4f},{:.4f} left font ',14' tc rgb '#{}'\n",
                       literal(text), 20.0 / kWidth, 1.0 - (bottom - 14.0) / height_, kInk);
  }

 private:
  int height_;
};

std::string lane_lines(const EpisodeTrace& trace) {
  std::string script;
  for (int line = 0; line <= trace.lanes; ++line) {
    const bool edge = line == 0 || line == trace.lanes;
    script += fmt::format(
        "set arrow {0} from graph 0,first {1:.3f} to graph 1,first {1:.3f} nohead back lc rgb "
        "'#{2}' lw 1{3}\n",
        line + 1, line * trace.lane_width_m, edge ? "888888" : "bbbbbb", edge ? "" : " dt (10,8)");
  }
  return script;
}

std::string over_time(const EpisodeTrace& trace, const char* block,
                      double (*value)(const TracedStep&)) {
  std::string text = fmt::format("{} << EOD\n", block);
  for (std::size_t i = 0; i < trace.steps.size(); ++i) {
    text += fmt::format("{:.6g} {:.6g}\n", static_cast<double>(i) * trace.step_s,
                        value(trace.steps[i]));
  }
  return text + "EOD\n";
}

std::string typical_script(const EpisodeTrace& trace, const Page& page, int top) {
  const double duration_s = static_cast<double>(trace.steps.size() - 1) * trace.step_s;
  const double road_m = trace.lanes * trace.lane_width_m;
  const int lanes_bottom = top + kLanesHeight;
  std::string ticks;
  for (int lane = 0; lane < trace.lanes; ++lane) {
    const char* name = lane == 0 ? "right lane" : lane == trace.lanes - 1 ? "left lane" : "";
    ticks += fmt::format("{}{} {:.3f}", lane == 0 ? "" : ", ", literal(name),
                         (lane + 0.5) * trace.lane_width_m);
  }
  const std::string line =
      fmt::format(" using 1:2 with lines lw 1.6 lc rgb '#{}' notitle\n", kColours[0]);
  return over_time(trace, "$lateral", [](const TracedStep& step) { return step.ego.d_m; }) +
         over_time(trace, "$speed",
                   [](const TracedStep& step) { return kKphPerMps * step.ego.speed_mps; }) +
         page.at(top, lanes_bottom) +
         fmt::format("set xrange [0:{:.6g}] noextend\nset yrange [0:{:.6g}]\n", duration_s,
                     road_m) +
         "set border 0\nset format x ''\nset xtics scale 0\n" +
         fmt::format("set ytics ({}) scale 0\n", ticks) + lane_lines(trace) + "plot $lateral" +
         line + "unset arrow\nunset label\n" +
         page.at(lanes_bottom + kStripGap, lanes_bottom + kStripGap + kSpeedHeight) +
         "set border 3\nset format x '%g'\nset xtics auto scale 0.6\nset ytics auto scale 0.6\n"
         "set xlabel 'time, s'\nset ylabel 'km/h'\nset grid ytics lt 1 lc rgb '#e4e4e4' lw 0.7\n" +
         fmt::format("set yrange [0:{:.6g}]\n", 1.1 * kKphPerMps * trace.speed_limit_mps) +
         fmt::format("plot {:.6g} with lines lw 1 dt (8,5) lc rgb '#{}' notitle, $speed",
                     kKphPerMps * trace.speed_limit_mps, kInk) +
         line + "unset xlabel\nunset ylabel\nunset grid\n";
}

std::string rectangle(int number, const TracedVehicle& vehicle, const TracedVehicle& ego,
                      const char* colour) {
  const double front_m = vehicle.s_m - ego.s_m;
  return fmt::format(
      "set object {} rectangle from {:.3f},{:.3f} to {:.3f},{:.3f} fc rgb '#{}' fs solid noborder\n"
      "set label {} '{:.0f}' at {:.3f},{:.3f} center font ',8' front tc rgb '#ffffff'\n",
      number, front_m - vehicle.length_m, vehicle.d_m - vehicle.width_m / 2, front_m,
      vehicle.d_m + vehicle.width_m / 2, colour, number + 10, kKphPerMps * vehicle.speed_mps,
      front_m - vehicle.length_m / 2, vehicle.d_m);
}

std::string failed_script(const EpisodeTrace& trace, const Page& page, int top) {
  const std::size_t count = instants(trace);
  const double road_m = trace.lanes * trace.lane_width_m;
  std::string script =
      "set border 0\nunset ytics\nset yrange [0:" + fmt::format("{:.6g}]\n", road_m) +
      fmt::format("set xrange [{}:{}] noextend\n", -kBehind_m, kAhead_m);
  for (std::size_t i = 0; i < count; ++i) {
    const TracedStep& step = trace.steps[trace.steps.size() - count + i];
    const double before_s = static_cast<double>(count - 1 - i) * trace.step_s;
    const int strip_top = top + static_cast<int>(i) * (strip_height(trace) + kStripGap);
    const bool last = i + 1 == count;
    script += page.at(strip_top, strip_top + strip_height(trace)) + lane_lines(trace);
    script += last
                  ? "set xtics auto scale 0.6\nset format x '%g'\nset xlabel 'm ahead of the ego'\n"
                  : "set format x ''\nset xtics scale 0\n";
    std::string when = last ? "collision" : fmt::format("{:g} s before", before_s);
    script += fmt::format("set label 2 {} at graph -0.015,0.62 right tc rgb '#{}'\n", literal(when),
                          kInk);
    if (step.command) {
      const auto command = static_cast<std::size_t>(*step.command);
      script += fmt::format(
          "set label 3 {} at graph -0.015,0.36 right tc rgb '#777777'\n",
          literal(fmt::format("BP: {}", command < kCommands.size() ? kCommands[command] : "?")));
    }
    int number = 20;
    for (const TracedVehicle& other : step.others) {
      const double front_m = other.s_m - step.ego.s_m;
      if (front_m - other.length_m > kAhead_m || front_m < -kBehind_m) continue;
      const bool hit = trace.collision && trace.collision->other == other.id;
      script += rectangle(number++, other, step.ego, hit ? kColours[1] : "9a9a9a");
    }
    script += rectangle(number, step.ego, step.ego, kColours[0]);
    script += "plot NaN notitle\nunset object\nunset label\nunset arrow\n";
  }
  return script + "unset xlabel\n";
}

}  // namespace

std::string gnuplot_script(const EpisodeFigure& figure, PictureFormat format) {
  const int typical_height =
      figure.typical ? kTitle + kLanesHeight + kStripGap + kSpeedHeight + kAxis : 0;
  int failed_height = 0;
  if (figure.failed) {
    const EpisodeTrace& trace = figure.failed->trace;
    failed_height =
        kTitle + kAxis + static_cast<int>(instants(trace)) * (strip_height(trace) + kStripGap);
  }
  const int height = typical_height + failed_height;
  const Page page(height);
  std::string script = terminal_script("episodes", kWidth, height, format) +
                       fmt::format(
                           "set termoption noenhanced\nset border lc rgb '#{0}'\n"
                           "set tics nomirror out textcolor rgb '#{0}'\nset multiplot\n",
                           kInk);
  if (figure.typical) {
    script += page.title(kTitle, figure.planner + ", a typical episode") +
              typical_script(figure.typical->trace, page, kTitle);
  }
  if (figure.failed) {
    script += page.title(typical_height + kTitle, figure.planner + ", before a collision") +
              failed_script(figure.failed->trace, page, typical_height + kTitle);
  }
  return script + "unset multiplot\n";
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
    std::string kind = trace.collision ? trace.collision->kind : "";
    std::ranges::replace(kind, '_', ' ');
    text += fmt::format(
        " Before a collision, the first with its seed ({}, {}): blue is the ego, orange the other "
        "vehicle, the numbers are km/h.",
        figure.failed->name, kind);
  }
  return text;
}

}  // namespace corridor::cluster
