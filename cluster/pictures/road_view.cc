// SPDX-License-Identifier: Apache-2.0
#include "cluster/pictures/road_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "proto/base/text.h"

namespace corridor::cluster {
namespace {

constexpr double kEdge = 2.0;                    // pixels beside the road, for its edge lines
constexpr double kMark_m = 3.0, kEvery_m = 9.0;  // of the marks between lanes
constexpr double kSpeedSize = 13.0;              // pixels

// Where the road's (s, d) are on the canvas.
struct Place {
  double ego_s_m;
  double road_m;
  const RoadView& view;

  double scale() const { return view.width / (view.behind_m + view.ahead_m); }  // pixels a metre
  double x(double s_m) const { return (s_m - ego_s_m + view.behind_m) * scale(); }
  double y(double d_m) const { return kEdge + (road_m - d_m) * scale(); }
};

// As the MoP was shown them when it decided.
void draw_corridors(Canvas& canvas, const Place& place, const TracedStep& step) {
  const TracedDecision& decision = *step.decision;
  const auto count = static_cast<int>(decision.front_gaps_m.size());
  const double width_m = place.road_m / std::max(1, count);
  for (std::size_t i = 0; i < decision.window_open.size(); ++i) {
    const int corridor = decision.window_first + static_cast<int>(i);
    if (!decision.window_open[i] || corridor < 0 || corridor >= count) continue;
    const auto at = static_cast<std::size_t>(corridor);
    const double from = place.x(step.ego.s_m - step.ego.length_m - decision.back_gaps_m[at]);
    const double to = place.x(step.ego.s_m + decision.front_gaps_m[at]);
    canvas.rectangle(from, place.y((corridor + 1) * width_m) + 1, to - from,
                     width_m * place.scale() - 2, corridor == decision.corridor ? kChosen : kOpen);
  }
}

void draw_lane_lines(Canvas& canvas, const Place& place, const EpisodeTrace& trace) {
  for (int lane = 0; lane <= trace.lanes; ++lane) {
    const double y = place.y(lane * trace.lane_width_m);
    if (lane == 0 || lane == trace.lanes) {
      canvas.add(Line{{{0.0, y}, {canvas.width, y}}, kLine, 2.5});
      continue;
    }
    // The marks stand still on the road.
    const double first_m = std::floor((place.ego_s_m - place.view.behind_m) / kEvery_m) * kEvery_m;
    for (double s_m = first_m; s_m < place.ego_s_m + place.view.ahead_m; s_m += kEvery_m)
      canvas.add(Line{{{place.x(s_m), y}, {place.x(s_m + kMark_m), y}}, kLine, 2.0});
  }
}

void draw_trajectory(Canvas& canvas, const Place& place, const TracedDecision& decision) {
  Line line{{}, kPath, 2.5};
  for (std::size_t i = 0; i < decision.path_s_m.size(); ++i)
    line.points.push_back({place.x(decision.path_s_m[i]), place.y(decision.path_d_m[i])});
  canvas.add(std::move(line));
}

// The outline of a vehicle that points to the right, with its front bumper's middle at 0, 0; its
// front corners are round.
std::vector<Point> outline(double length, double width) {
  constexpr int kCornerPoints = 6;
  const double corner = 0.25 * width;
  std::vector<Point> points;
  for (const double side : {-1.0, 1.0}) {
    for (int i = 0; i < kCornerPoints; ++i) {
      const double share = i / (kCornerPoints - 1.0);
      const double angle = (side < 0.0 ? share - 1.0 : share) * std::numbers::pi / 2;
      points.push_back({corner * (std::cos(angle) - 1.0),
                        side * (width / 2 - corner) + corner * std::sin(angle)});
    }
  }
  points.push_back({-length, width / 2});
  points.push_back({-length, -width / 2});
  return points;
}

void draw_vehicle(Canvas& canvas, const Place& place, const TracedVehicle& vehicle, Colour colour) {
  const double length = vehicle.length_m * place.scale();
  const double width = vehicle.width_m * place.scale();
  const double cos = std::cos(vehicle.yaw_rad), sin = std::sin(vehicle.yaw_rad);
  const Point front{place.x(vehicle.s_m), place.y(vehicle.d_m)};
  if (front.x < 0.0 || front.x - length > canvas.width) return;
  const auto turned = [&](const Point& point) {
    return Point{front.x + point.x * cos + point.y * sin, front.y - point.x * sin + point.y * cos};
  };
  Area area{outline(length, width), colour};
  std::ranges::transform(area.corners, area.corners.begin(), turned);
  canvas.add(std::move(area));
  if (width <= kSpeedSize + 1) return;
  canvas.add(Text{turned({-length / 2, 0.35 * kSpeedSize}), kSpeedSize,
                  fmt::format("{:.0f}", kKphPerMps * vehicle.speed_mps), Anchor::kMiddle, kPaper,
                  vehicle.yaw_rad});
}

}  // namespace

Canvas road_from_above(const Clip& clip, double time_s, const RoadView& view) {
  const TracedScene scene = clip.scene_at(time_s);
  const TracedStep& step = clip.step_at(time_s);
  const Place place{scene.ego.s_m, clip.trace.lanes * clip.trace.lane_width_m, view};
  Canvas canvas{view.width, place.road_m * place.scale() + 2 * kEdge};
  canvas.rectangle(0.0, kEdge, canvas.width, canvas.height - 2 * kEdge, kAsphalt);
  if (step.decision) draw_corridors(canvas, place, step);
  draw_lane_lines(canvas, place, clip.trace);
  if (step.decision) draw_trajectory(canvas, place, *step.decision);
  const bool hit_shows =
      clip.trace.collision && (view.hit_stands_out_before || time_s >= clip.duration_s() - 1e-9);
  for (const TracedVehicle& other : scene.others) {
    const bool hit = hit_shows && clip.trace.collision->other == other.id;
    draw_vehicle(canvas, place, other, hit ? kHit : kOther);
  }
  draw_vehicle(canvas, place, scene.ego, kEgo);
  return canvas;
}

}  // namespace corridor::cluster
