#include "cluster/pictures/film.h"

#include <cairo.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "proto/base/failure.h"
#include "proto/base/format.h"
#include "proto/run/run_directory.h"
#include "proto/system/files.h"
#include "proto/system/subprocess.h"

namespace corridor::cluster {
namespace {

namespace fs = std::filesystem;

constexpr double kKphPerMps = 3.6;
constexpr double kBehind_m = 35.0, kAhead_m = 65.0;  // of the ego's front
constexpr int kWidth = 1280;
constexpr double kMargin = 24.0;
constexpr double kScale = (kWidth - 2 * kMargin) / (kBehind_m + kAhead_m);  // pixels a metre
constexpr double kTitleHeight = 44.0;
constexpr double kPanelHeight = 210.0;
constexpr double kRowLabelHeight = 24.0;
constexpr std::array kCommands = {"keep", "left", "right"};

struct Colour {
  double red, green, blue;
};
constexpr Colour kInk{0.18, 0.18, 0.20}, kFaint{0.55, 0.55, 0.58}, kPaper{1.0, 1.0, 1.0};
constexpr Colour kAsphalt{0.93, 0.93, 0.94}, kLine{0.72, 0.72, 0.75}, kOther{0.52, 0.54, 0.58};
constexpr Colour kEgo{0.0, 0.35, 0.71}, kHit{0.80, 0.15, 0.12}, kGap{0.64, 0.81, 0.95};
constexpr Colour kChosen{0.99, 0.74, 0.32}, kPath{0.86, 0.37, 0.0};

// A picture that is drawn and written.
class Canvas {
 public:
  Canvas(int width, int height)
      : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height)),
        cairo_(cairo_create(surface_)) {
    colour(kPaper);
    cairo_paint(cairo_);
    cairo_select_font_face(cairo_, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  }
  ~Canvas() {
    cairo_destroy(cairo_);
    cairo_surface_destroy(surface_);
  }
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  void colour(const Colour& c, double alpha = 1.0) {
    cairo_set_source_rgba(cairo_, c.red, c.green, c.blue, alpha);
  }
  void rectangle(double x, double y, double width, double height) {
    cairo_rectangle(cairo_, x, y, width, height);
    cairo_fill(cairo_);
  }
  void outline(double x, double y, double width, double height, double line) {
    cairo_set_line_width(cairo_, line);
    cairo_rectangle(cairo_, x, y, width, height);
    cairo_stroke(cairo_);
  }
  void line(const std::vector<std::array<double, 2>>& points, double width, double dash = 0.0) {
    cairo_new_path(cairo_);  // texts leave a point behind
    cairo_set_line_width(cairo_, width);
    cairo_set_dash(cairo_, &dash, dash > 0.0 ? 1 : 0, 0.0);
    for (const auto& [x, y] : points) cairo_line_to(cairo_, x, y);
    cairo_stroke(cairo_);
    cairo_set_dash(cairo_, nullptr, 0, 0.0);
  }
  // Horizontally from `anchor` of its width: 0 begins, 0.5 is centred, 1 ends there.
  void text(double x, double y, double size, const std::string& what, double anchor = 0.0) {
    cairo_set_font_size(cairo_, size);
    cairo_text_extents_t extents;
    cairo_text_extents(cairo_, what.c_str(), &extents);
    cairo_move_to(cairo_, x - anchor * extents.x_advance, y);
    cairo_show_text(cairo_, what.c_str());
  }
  cairo_t* operator()() { return cairo_; }

  void write(const fs::path& file) {
    const cairo_status_t status = cairo_surface_write_to_png(surface_, file.c_str());
    if (status != CAIRO_STATUS_SUCCESS) {
      throw Failure("cannot write {}: {}", file.string(), cairo_status_to_string(status));
    }
  }

 private:
  cairo_surface_t* surface_;
  cairo_t* cairo_;
};

double road_height(const Clip& clip) { return clip.trace.lanes * clip.trace.lane_width_m * kScale; }

// The road around the ego at one instant; its left edge is at `top`.
class RoadView {
 public:
  RoadView(Canvas& canvas, const Clip& clip, double time_s, double top)
      : canvas_(canvas), clip_(clip), time_s_(time_s), scene_(clip.scene_at(time_s)), top_(top) {}

  void draw() {
    cairo_save(canvas_());
    cairo_rectangle(canvas_(), kMargin, top_ - 2, kWidth - 2 * kMargin, road_height(clip_) + 4);
    cairo_clip(canvas_());
    canvas_.colour(kAsphalt);
    canvas_.rectangle(kMargin, top_, kWidth - 2 * kMargin, road_height(clip_));
    const TracedStep& step = clip_.step_at(time_s_);
    if (step.decision) corridors(step);
    lane_lines();
    if (step.decision) path(*step.decision);
    const bool at_end = time_s_ >= clip_.duration_s() - 1e-9;
    for (const TracedVehicle& other : scene_.others) {
      const bool hit = at_end && clip_.trace.collision && clip_.trace.collision->other == other.id;
      vehicle(other, hit ? kHit : kOther);
    }
    vehicle(scene_.ego, kEgo);
    cairo_restore(canvas_());
  }

 private:
  double x(double s_m) const { return kMargin + (s_m - scene_.ego.s_m + kBehind_m) * kScale; }
  double y(double d_m) const { return top_ + road_height(clip_) - d_m * kScale; }

  // As the MoP was shown them when it decided: how far each open one is free.
  void corridors(const TracedStep& step) {
    const TracedDecision& decision = *step.decision;
    const auto count = decision.front_gaps_m.size();
    const double width_m = clip_.trace.lanes * clip_.trace.lane_width_m /
                           static_cast<double>(std::max<std::size_t>(1, count));
    for (std::size_t i = 0; i < decision.window_open.size(); ++i) {
      const int corridor = decision.window_first + static_cast<int>(i);
      if (!decision.window_open[i] || corridor < 0 || corridor >= static_cast<int>(count)) continue;
      const auto at = static_cast<std::size_t>(corridor);
      const double from_m = step.ego.s_m - step.ego.length_m - decision.back_gaps_m[at];
      const double to_m = step.ego.s_m + decision.front_gaps_m[at];
      const bool chosen = corridor == decision.corridor;
      canvas_.colour(chosen ? kChosen : kGap, chosen ? 0.75 : 0.6);
      canvas_.rectangle(x(from_m), y((corridor + 1) * width_m) + 1, (to_m - from_m) * kScale,
                        width_m * kScale - 2);
    }
  }

  void lane_lines() {
    canvas_.colour(kLine);
    for (int lane = 0; lane <= clip_.trace.lanes; ++lane) {
      const double at = y(lane * clip_.trace.lane_width_m);
      const bool edge = lane == 0 || lane == clip_.trace.lanes;
      if (edge) {
        canvas_.line({{kMargin, at}, {kWidth - kMargin, at}}, 2.5);
        continue;
      }
      // Marks of 3 m every 9 m, standing still on the road.
      constexpr double kMark_m = 3.0, kEvery_m = 9.0;
      const double first_m = std::floor((scene_.ego.s_m - kBehind_m) / kEvery_m) * kEvery_m;
      for (double s_m = first_m; s_m < scene_.ego.s_m + kAhead_m; s_m += kEvery_m)
        canvas_.line({{x(s_m), at}, {x(s_m + kMark_m), at}}, 2.0);
    }
  }

  void path(const TracedDecision& decision) {
    std::vector<std::array<double, 2>> points;
    for (std::size_t i = 0; i < decision.path_s_m.size(); ++i)
      points.push_back({x(decision.path_s_m[i]), y(decision.path_d_m[i])});
    canvas_.colour(kPath);
    canvas_.line(points, 2.5);
  }

  void vehicle(const TracedVehicle& vehicle, const Colour& colour) {
    cairo_save(canvas_());
    cairo_translate(canvas_(), x(vehicle.s_m), y(vehicle.d_m));
    cairo_rotate(canvas_(), -vehicle.yaw_rad);
    const double length = vehicle.length_m * kScale, width = vehicle.width_m * kScale;
    canvas_.colour(colour);
    const double corner = 0.25 * width;
    cairo_new_sub_path(canvas_());
    cairo_arc(canvas_(), -corner, -width / 2 + corner, corner, -std::numbers::pi / 2, 0);
    cairo_arc(canvas_(), -corner, width / 2 - corner, corner, 0, std::numbers::pi / 2);
    cairo_line_to(canvas_(), -length, width / 2);
    cairo_line_to(canvas_(), -length, -width / 2);
    cairo_close_path(canvas_());
    cairo_fill(canvas_());
    canvas_.colour(kPaper);
    if (width > 14) {
      canvas_.text(-length / 2, 4.5, 13, fmt::format("{:.0f}", kKphPerMps * vehicle.speed_mps),
                   0.5);
    }
    cairo_restore(canvas_());
  }

  Canvas& canvas_;
  const Clip& clip_;
  double time_s_;
  TracedScene scene_;
  double top_;
};

// Bars of the BP's values, the command given in the colour of what is chosen.
void draw_bp_values(Canvas& canvas, const TracedStep& step, double left, double top) {
  canvas.colour(kInk);
  canvas.text(left, top + 14, 14, "BP: value of each command");
  if (!step.decision) return;
  const std::vector<double>& values = step.decision->bp_values;
  const auto command = static_cast<std::size_t>(step.command.value_or(0));
  if (values.size() != kCommands.size()) {
    canvas.text(left, top + 44, 16, fmt::format("asks for {}", kCommands[command]));
    return;
  }
  const auto [low, high] = std::ranges::minmax(values);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double y = top + 34 + 40 * static_cast<double>(i);
    canvas.colour(i == command ? kChosen : kGap);
    const double share = high > low ? (values[i] - low) / (high - low) : 1.0;
    canvas.rectangle(left + 52, y, 30 + 130 * share, 24);
    canvas.colour(kInk);
    canvas.text(left, y + 17, 14, kCommands[i]);
    canvas.text(left + 58, y + 17, 13, fmt::format("{:.2f}", values[i]));
  }
}

// The MoP's values: corridor changes side by side, speed changes below each other.
void draw_mop_values(Canvas& canvas, const Clip& clip, const TracedStep& step, double left,
                     double top) {
  canvas.colour(kInk);
  canvas.text(left, top + 14, 14, "MoP: value of each action");
  if (!step.decision || step.decision->mop_values.empty()) return;
  const std::vector<double>& values = step.decision->mop_values;
  constexpr std::size_t kChanges = 3;  // right, none, left
  constexpr std::array kNames = {"right", "straight", "left"};
  const std::size_t rows = values.size() / kChanges;
  const auto [low, high] = std::ranges::minmax(values);
  const double height = std::min(24.0, 150.0 / static_cast<double>(rows)), width = 66.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t row = rows - 1 - i / kChanges, column = kChanges - 1 - i % kChanges;
    const double x = left + 58 + width * static_cast<double>(column);
    const double y = top + 40 + height * static_cast<double>(row);
    const double share = high > low ? (values[i] - low) / (high - low) : 1.0;
    canvas.colour(kGap, 0.1 + 0.9 * share * share);
    canvas.rectangle(x, y, width - 2, height - 2);
    if (static_cast<int>(i) == step.decision->mop_action) {
      canvas.colour(kPath);
      canvas.outline(x, y, width - 2, height - 2, 2.5);
    }
    canvas.colour(kInk);
    canvas.text(x + width / 2 - 1, y + height / 2 + 4, 12, fmt::format("{:.2f}", values[i]), 0.5);
    if (row == 0) canvas.text(x + width / 2 - 1, top + 34, 12, kNames[i % kChanges], 0.5);
    if (column == 0 && i / kChanges < clip.speed_changes_mps.size()) {
      canvas.text(left + 52, y + height / 2 + 4, 12,
                  fmt::format("{:+g} m/s", clip.speed_changes_mps[i / kChanges]), 1.0);
    }
  }
}

constexpr double kGapMax_m = 50.0;
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

// What the ego did, and its leader, at every kEvery_s of a clip: once for all its frames.
struct History {
  static constexpr double kEvery_s = 0.1;
  using Values = std::vector<std::optional<double>>;
  Values speed_mps, leader_mps, gap_m, d_m;
};

History history_of(const Clip& clip) {
  History history;
  for (double t = 0.0; t <= clip.duration_s() + 1e-9; t += History::kEvery_s) {
    const TracedScene scene = clip.scene_at(t);
    const Leader leader = leader_of(scene);
    history.speed_mps.push_back(scene.ego.speed_mps);
    history.leader_mps.push_back(leader.speed_mps);
    history.gap_m.push_back(leader.gap_m);
    history.d_m.push_back(scene.ego.d_m);
  }
  return history;
}

// A curve over a clip's time, drawn up to now, with gaps where there is no value.
class Plot {
 public:
  static constexpr double kWidth = 520.0, kHeight = 44.0, kEvery = 68.0;

  Plot(Canvas& canvas, double left, double top, double top_value, double duration_s)
      : canvas_(canvas), left_(left), top_(top), top_value_(top_value), duration_s_(duration_s) {}

  void frame(const std::string& title, const std::string& scale) {
    canvas_.colour(kInk);
    canvas_.text(left_, top_ - 6, 13, title);
    canvas_.colour(kAsphalt);
    canvas_.rectangle(left_, top_, kWidth, kHeight);
    canvas_.colour(kFaint);
    canvas_.text(left_ + kWidth - 4, top_ + 12, 11, scale, 1.0);
  }

  void curve(const History::Values& values, double until_s, const Colour& colour) {
    canvas_.colour(colour);
    std::vector<std::array<double, 2>> points;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double t = static_cast<double>(i) * History::kEvery_s;
      if (t > until_s + 1e-9) break;
      if (values[i]) {
        points.push_back({left_ + kWidth * t / duration_s_, y(*values[i])});
      } else if (!points.empty()) {
        canvas_.line(std::exchange(points, {}), 2.0);
      }
    }
    if (!points.empty()) canvas_.line(points, 2.0);
  }

  void level(double value) {
    canvas_.colour(kLine);
    canvas_.line({{left_, y(value)}, {left_ + kWidth, y(value)}}, 1.0, 6.0);
  }

 private:
  double y(double value) const { return top_ + kHeight * (1.0 - value / top_value_); }

  Canvas& canvas_;
  double left_, top_, top_value_, duration_s_;
};

// Up to now: speed and the leader's, the gap to it, and place across the road.
void draw_history(Canvas& canvas, const Clip& clip, const History& history, double time_s,
                  double left, double top) {
  const double limit_mps = 1.1 * clip.trace.speed_limit_mps;
  const double road_m = clip.trace.lanes * clip.trace.lane_width_m;
  const double duration_s = std::max(clip.duration_s(), clip.trace.step_s);
  const TracedScene scene = clip.scene_at(time_s);
  const Leader leader = leader_of(scene);
  const TracedStep& step = clip.step_at(time_s);

  std::string speed = fmt::format("speed {:.0f} km/h", kKphPerMps * scene.ego.speed_mps);
  if (leader.speed_mps) speed += fmt::format(", leader {:.0f}", kKphPerMps * *leader.speed_mps);
  if (step.decision) {
    speed += fmt::format(", set-point {:.0f}; reward of this step: BP {:.2f}, MoP {:.2f}",
                         kKphPerMps * step.decision->set_point_mps, step.decision->bp_reward,
                         step.decision->mop_reward);
  }
  Plot speeds(canvas, left, top + 20, limit_mps, duration_s);
  speeds.frame(speed, fmt::format("{:.0f} km/h", kKphPerMps * limit_mps));
  speeds.curve(history.leader_mps, time_s, kOther);
  speeds.curve(history.speed_mps, time_s, kEgo);

  Plot gap(canvas, left, top + 20 + Plot::kEvery, kGapMax_m, duration_s);
  gap.frame(
      leader.speed_mps ? fmt::format("gap to the leader {:.0f} m", leader.gap_m) : "nobody ahead",
      fmt::format("{:g} m", kGapMax_m));
  gap.curve(history.gap_m, time_s, kEgo);

  Plot across(canvas, left, top + 20 + 2 * Plot::kEvery, road_m, duration_s);
  across.frame("place across the road", fmt::format("{:g} m", road_m));
  across.curve(history.d_m, time_s, kEgo);
  for (int lane = 1; lane < clip.trace.lanes; ++lane) across.level(lane * clip.trace.lane_width_m);
}

void draw_frame(Canvas& canvas, const Clip& clip, const History& history, double time_s) {
  canvas.colour(kInk);
  canvas.text(kMargin, 28, 17, clip.title);
  canvas.text(kWidth - kMargin, 28, 17, fmt::format("{:.1f} s", clip.start_s + time_s), 1.0);
  RoadView(canvas, clip, time_s, kTitleHeight).draw();
  const double top = kTitleHeight + road_height(clip) + 22;
  const TracedStep& step = clip.step_at(time_s);
  draw_bp_values(canvas, step, kMargin, top);
  draw_mop_values(canvas, clip, step, kMargin + 270, top);
  draw_history(canvas, clip, history, time_s, kWidth - kMargin - 520, top);
}

int frame_height(const Clip& clip) {
  // Even, as H.264 wants it.
  return 2 * static_cast<int>((kTitleHeight + road_height(clip) + 22 + kPanelHeight) / 2);
}

// A folder for the frames of a film; gone with it.
class FrameFolder {
 public:
  explicit FrameFolder(const fs::path& film) : path_(film.string() + ".frames") {
    on_disk("remove", path_, [&] { fs::remove_all(path_); });
    on_disk("create", path_, [&] { fs::create_directories(path_); });
  }
  ~FrameFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  FrameFolder(const FrameFolder&) = delete;
  FrameFolder& operator=(const FrameFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

void write_frame(const Clip& clip, const History& history, double time_s, const fs::path& file) {
  Canvas canvas(kWidth, frame_height(clip));
  draw_frame(canvas, clip, history, time_s);
  canvas.write(file);
}

}  // namespace

void write_frame(const Clip& clip, double time_s, const fs::path& file) {
  write_frame(clip, history_of(clip), time_s, file);
}

void write_contact_sheet(const std::vector<Clip>& clips, double interval_s, const fs::path& file) {
  CORRIDOR_CHECK(!clips.empty() && interval_s > 0.0, "{} clips", clips.size());
  struct Row {
    const Clip* clip;
    double time_s;
    std::string label;
  };
  std::vector<Row> rows;
  for (const Clip& clip : clips) {
    const double duration_s = clip.duration_s();
    if (clips.size() > 1) {
      rows.push_back({&clip, duration_s, clip.title});
      continue;
    }
    const int intervals = static_cast<int>(duration_s / interval_s + 1e-9);
    for (int i = intervals; i >= 0; --i) {
      const double time_s = duration_s - i * interval_s;
      const double after_s = (intervals - i) * interval_s;
      rows.push_back({&clip, time_s,
                      i == intervals ? fmt::format("t0 = {:.1f} s", clip.start_s + time_s)
                                     : fmt::format("t0 + {:g} s", after_s)});
    }
  }
  const double row_height = kRowLabelHeight + road_height(clips.front()) + 10;
  const double height = kTitleHeight + row_height * static_cast<double>(rows.size());
  Canvas canvas(kWidth, static_cast<int>(height) + 10);
  canvas.colour(kInk);
  if (clips.size() == 1) canvas.text(kMargin, 28, 17, clips.front().title);
  double top = kTitleHeight;
  for (const Row& row : rows) {
    canvas.colour(kInk);
    std::string label = row.label;
    const TracedStep& step = row.clip->step_at(row.time_s);
    if (step.command) {
      label += fmt::format(", BP: {}", kCommands[static_cast<std::size_t>(*step.command)]);
    }
    canvas.text(kMargin, top + 16, 14, label);
    RoadView(canvas, *row.clip, row.time_s, top + kRowLabelHeight).draw();
    top += row_height;
  }
  canvas.write(file);
}

void write_film(const std::vector<Clip>& clips, const fs::path& file,
                const std::function<void(double)>& progress) {
  constexpr std::chrono::minutes kPatience{10};
  const auto ffmpeg = find_program("ffmpeg");
  if (!ffmpeg) throw Failure("no ffmpeg: films need it (cluster/setup installs it)");
  double all_s = 0.0;
  for (const Clip& clip : clips) all_s += clip.duration_s();
  FrameFolder folder(file);
  int frame = 0;
  for (const Clip& clip : clips) {
    const History history = history_of(clip);
    const int frames = static_cast<int>(clip.duration_s() * kFramesPerSecond + 1e-9);
    for (int i = 0; i <= frames; ++i) {
      const double time_s = static_cast<double>(i) / kFramesPerSecond;
      write_frame(clip, history, time_s, folder.path() / fmt::format("{:06}.png", frame++));
      progress(std::min(1.0, frame / (all_s * kFramesPerSecond + 1.0)));
    }
  }
  const auto done =
      run_subprocess(*ffmpeg,
                     {"-y", "-loglevel", "error", "-framerate", std::to_string(kFramesPerSecond),
                      "-i", (folder.path() / "%06d.png").string(), "-c:v", "libx264", "-crf", "20",
                      "-pix_fmt", "yuv420p", "-movflags", "+faststart", file.string()},
                     "", kPatience);
  if (!done) throw Failure("ffmpeg did not write {} within ten minutes", file.string());
  if (done->status != 0) {
    throw Failure("ffmpeg cannot write {}: {}", file.string(),
                  done->errors.substr(0, done->errors.find('\n')));
  }
}

}  // namespace corridor::cluster
