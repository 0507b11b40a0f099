// SPDX-License-Identifier: Apache-2.0
#include "cluster/pictures/film.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "cluster/pictures/road_view.h"
#include "proto/base/failure.h"
#include "proto/base/text.h"
#include "proto/system/files.h"
#include "proto/system/program.h"
#include "proto/system/subprocess.h"

namespace corridor::cluster {
namespace {

namespace fs = std::filesystem;

constexpr int kFramesPerSecond = 10;
constexpr std::chrono::minutes kPatience{10};

constexpr int kFrameWidth = 1280;
constexpr double kFrameMargin = 24.0, kFrameTitleHeight = 42.0, kPanelHeight = 210.0;
constexpr double kChartWidth = 520.0, kChartHeight = 44.0, kChartEvery = 68.0;
constexpr RoadView kFrameRoad{.width = kFrameWidth - 2 * kFrameMargin};

constexpr double kHistoryEvery_s = 0.1;
constexpr double kGapMax_m = 50.0;

// Where a value lies between the least and the greatest.
double share_of(double value, const std::vector<double>& values) {
  const auto [least, greatest] = std::ranges::minmax(values);
  return greatest > least ? (value - least) / (greatest - least) : 1.0;
}

// Bars of the BP's values, the command given in the colour of what is chosen.
void draw_bp_values(Canvas& canvas, const EpisodeTrace& trace, const TracedStep& step, double left,
                    double top) {
  canvas.add(Text{{left, top + 14}, 14, "BP: value of each command"});
  if (!step.decision || !step.command) return;
  const std::vector<double>& values = step.decision->bp_values;
  if (values.empty()) {
    canvas.add(Text{{left, top + 44}, 16, "asks for " + trace.command_name(*step.command)});
    return;
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double y = top + 34 + 40 * static_cast<double>(i);
    canvas.rectangle(left + 52, y, 30 + 130 * share_of(values[i], values), 24,
                     static_cast<int>(i) == *step.command ? kChosen : kOpen);
    canvas.add(Text{{left, y + 17}, 14, trace.command_name(static_cast<int>(i))});
    canvas.add(Text{{left + 58, y + 17}, 13, fmt::format("{:.2f}", values[i])});
  }
}

// The MoP's values: corridor changes side by side, speed changes below each other.
void draw_mop_values(Canvas& canvas, const Clip& clip, const TracedStep& step, double left,
                     double top) {
  canvas.add(Text{{left, top + 14}, 14, "MoP: value of each action"});
  if (!step.decision || step.decision->mop_values.empty()) return;
  const std::vector<double>& values = step.decision->mop_values;
  constexpr std::size_t kChanges = kCorridorChanges.size();
  const std::size_t rows = values.size() / kChanges;
  const double height = std::min(24.0, 150.0 / static_cast<double>(rows)), width = 66.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t row = rows - 1 - i / kChanges, column = kChanges - 1 - i % kChanges;
    const double x = left + 58 + width * static_cast<double>(column);
    const double y = top + 40 + height * static_cast<double>(row);
    const double right = x + width - 2, bottom = y + height - 2, middle = x + width / 2 - 1;
    const double share = share_of(values[i], values);
    canvas.rectangle(x, y, width - 2, height - 2, mixed(kPaper, kOpen, 0.1 + 0.9 * share * share));
    if (static_cast<int>(i) == step.decision->mop_action)
      canvas.add(Line{{{x, y}, {right, y}, {right, bottom}, {x, bottom}, {x, y}}, kPath, 2.5});
    const double base = y + height / 2 + 4;
    canvas.add(Text{{middle, base}, 12, fmt::format("{:.2f}", values[i]), Anchor::kMiddle});
    if (row == 0) {
      canvas.add(Text{{middle, top + 34}, 12, kCorridorChanges[i % kChanges], Anchor::kMiddle});
    }
    if (column == 0 && i / kChanges < clip.speed_changes_mps.size()) {
      canvas.add(Text{{left + 52, base},
                      12,
                      fmt::format("{:+g} m/s", clip.speed_changes_mps[i / kChanges]),
                      Anchor::kEnd});
    }
  }
}

// Whoever is in the ego's way, nearer than kGapMax_m.
struct Leader {
  double gap_m = kGapMax_m;
  std::optional<double> speed_mps;  // of none when there is nobody
};
Leader leader_of(const TracedScene& scene) {
  Leader leader;
  for (const TracedVehicle& other : scene.others) {
    const double aside_m = std::abs(other.d_m - scene.ego.d_m);
    if (other.s_m <= scene.ego.s_m || aside_m >= (other.width_m + scene.ego.width_m) / 2) continue;
    const double gap_m = std::max(0.0, other.s_m - other.length_m - scene.ego.s_m);
    if (gap_m < leader.gap_m) leader = {gap_m, other.speed_mps};
  }
  return leader;
}

// An empty chart with a title above, and in it what its upper edge stands for.
void draw_box(Canvas& canvas, const Chart& chart, const std::string& title,
              const std::string& highest) {
  canvas.add(Text{{chart.left, chart.top - 6}, 13, title});
  canvas.rectangle(chart.left, chart.top, chart.width, chart.height, kAsphalt);
  canvas.add(
      Text{{chart.left + chart.width - 4, chart.top + 12}, 11, highest, Anchor::kEnd, kFaint});
}

std::string speed_text(const TracedScene& scene, const Leader& leader, const TracedStep& step) {
  std::string text = fmt::format("speed {:.0f} km/h", kKphPerMps * scene.ego.speed_mps);
  if (leader.speed_mps) text += fmt::format(", leader {:.0f}", kKphPerMps * *leader.speed_mps);
  if (step.decision) {
    text += fmt::format(", set-point {:.0f}; reward of this step: BP {:.2f}, MoP {:.2f}",
                        kKphPerMps * step.decision->set_point_mps, step.decision->bp_reward,
                        step.decision->mop_reward);
  }
  return text;
}

// Pictures (PNG) one after the other -> the film (MP4).
std::string encoded(const fs::path& ffmpeg, const UnnamedFile& frames) {
  const UnnamedFile film;  // where ffmpeg can go back and write the index to the front
  const auto done =
      run_subprocess(ffmpeg, {"-y",         "-loglevel",   "error",
                              "-f",         "image2pipe",  "-c:v",
                              "png",        "-framerate",  std::to_string(kFramesPerSecond),
                              "-i",         frames.path(), "-c:v",
                              "libx264",    "-crf",        "20",
                              "-pix_fmt",   "yuv420p",     "-movflags",
                              "+faststart", "-f",          "mp4",
                              film.path()},
                     "", kPatience);
  if (!done) throw Failure("ffmpeg was not done within {} min", kPatience.count());
  if (done->status != 0) {
    throw Failure("ffmpeg cannot make a film: {}", done->errors.substr(0, done->errors.find('\n')));
  }
  return film.content();
}

}  // namespace

Frames::Frames(const Clip& clip) : clip_(clip) {
  for (double time_s = 0.0; time_s <= clip.duration_s() + 1e-9; time_s += kHistoryEvery_s) {
    const TracedScene scene = clip.scene_at(time_s);
    const Leader leader = leader_of(scene);
    speed_mps_.push_back(scene.ego.speed_mps);
    leader_mps_.push_back(leader.speed_mps);
    gap_m_.push_back(leader.gap_m);
    d_m_.push_back(scene.ego.d_m);
  }
}

void Frames::draw_history(Canvas& canvas, double time_s, double left, double top) const {
  const EpisodeTrace& trace = clip_.trace;
  const double limit_mps = 1.1 * trace.speed_limit_mps, road_m = trace.lanes * trace.lane_width_m;
  const double duration_s = std::max(clip_.duration_s(), trace.step_s);
  const TracedScene scene = clip_.scene_at(time_s);
  const Leader leader = leader_of(scene);
  const Line own{{}, kEgo, 2.0}, others{{}, kOther, 2.0};

  const Chart speed{left, top + 20, kChartWidth, kChartHeight, duration_s, limit_mps};
  draw_box(canvas, speed, speed_text(scene, leader, clip_.step_at(time_s)),
           fmt::format("{:.0f} km/h", kKphPerMps * limit_mps));
  speed.curve(canvas, leader_mps_, kHistoryEvery_s, time_s, others);
  speed.curve(canvas, speed_mps_, kHistoryEvery_s, time_s, own);

  const Chart gap{left, speed.top + kChartEvery, kChartWidth, kChartHeight, duration_s, kGapMax_m};
  draw_box(
      canvas, gap,
      leader.speed_mps ? fmt::format("gap to the leader {:.0f} m", leader.gap_m) : "nobody ahead",
      fmt::format("{:g} m", kGapMax_m));
  gap.curve(canvas, gap_m_, kHistoryEvery_s, time_s, own);

  const Chart across{left, gap.top + kChartEvery, kChartWidth, kChartHeight, duration_s, road_m};
  draw_box(canvas, across, "place across the road", fmt::format("{:g} m", road_m));
  across.curve(canvas, d_m_, kHistoryEvery_s, time_s, own);
  for (int lane = 1; lane < trace.lanes; ++lane)
    across.level(canvas, lane * trace.lane_width_m, {{}, kLine, 1.0, 6.0});
}

Canvas Frames::at(double time_s) const {
  const Canvas road = road_from_above(clip_, time_s, kFrameRoad);
  const double top = kFrameTitleHeight + road.height + 20;
  Canvas canvas{kFrameWidth, 2.0 * std::floor((top + kPanelHeight) / 2)};
  canvas.add(Text{{kFrameMargin, 28}, 17, clip_.title});
  canvas.add(Text{{kFrameWidth - kFrameMargin, 28},
                  17,
                  fmt::format("{:.1f} s", clip_.start_s + time_s),
                  Anchor::kEnd});
  canvas.inset({kFrameMargin, kFrameTitleHeight}, road);
  const TracedStep& step = clip_.step_at(time_s);
  draw_bp_values(canvas, clip_.trace, step, kFrameMargin, top);
  draw_mop_values(canvas, clip_, step, kFrameMargin + 270, top);
  draw_history(canvas, time_s, kFrameWidth - kFrameMargin - kChartWidth, top);
  return canvas;
}

std::filesystem::path find_ffmpeg() {
  if (const auto program = find_program("ffmpeg")) return *program;
  throw Failure(
      "ffmpeg is not installed, and it makes the film: install it (Debian: apt-get install "
      "ffmpeg), or ask for --no-film");
}

void write_film(const std::vector<Clip>& clips, const fs::path& file,
                const std::function<void(double)>& progress) {
  const fs::path ffmpeg = find_ffmpeg();
  double all_s = 0.0;
  for (const Clip& clip : clips) all_s += clip.duration_s();
  UnnamedFile pictures;
  int drawn = 0;
  for (const Clip& clip : clips) {
    const Frames frames(clip);
    const int count = static_cast<int>(clip.duration_s() * kFramesPerSecond + 1e-9);
    for (int i = 0; i <= count; ++i) {
      throw_if_stopped();
      pictures.append(frames.at(static_cast<double>(i) / kFramesPerSecond).png());
      progress(std::min(1.0, ++drawn / (all_s * kFramesPerSecond + 1.0)));
    }
  }
  write_file(file, encoded(ffmpeg, pictures));
}

}  // namespace corridor::cluster
