// SPDX-License-Identifier: Apache-2.0
#include "actor/driving/corridors.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace corridor::driving {
namespace {

// A position on a line between two strips is, up to rounding, in the left one.
int strip_at(double d_m, double width_m, int strips) {
  constexpr double kRounding = 1e-9;
  return std::clamp(static_cast<int>(std::floor(d_m / width_m + kRounding)), 0, strips - 1);
}

CorridorGaps free_road(const PlannerSettings& planner) {
  return {planner.gap_range_m, 0.0, planner.gap_range_m, 0.0};
}

// The gaps that this vehicle alone would leave in a swath that it is in.
CorridorGaps gaps_to(const Vehicle& other, const Ego& ego, const DrivingSettings& settings) {
  const double ahead_m = other.s_m - other.length_m - ego.s_m;
  const double behind_m = ego.s_m - settings.ego.length_m - other.s_m;
  const bool beside = ahead_m < 0.0 && behind_m < 0.0;
  CorridorGaps gaps = free_road(settings.planner);
  if ((ahead_m >= 0.0 && ahead_m < gaps.front_gap_m) || beside) {
    gaps.front_gap_m = std::max(0.0, ahead_m);
    gaps.front_rate_mps = other.speed_mps - ego.speed_mps;
  }
  if ((behind_m >= 0.0 && behind_m < gaps.back_gap_m) || beside) {
    gaps.back_gap_m = std::max(0.0, behind_m);
    gaps.back_rate_mps = ego.speed_mps - other.speed_mps;
  }
  return gaps;
}

void keep_nearest(const CorridorGaps& one, CorridorGaps& nearest) {
  std::tie(nearest.front_gap_m, nearest.front_rate_mps) =
      std::min(std::pair(one.front_gap_m, one.front_rate_mps),
               std::pair(nearest.front_gap_m, nearest.front_rate_mps));
  std::tie(nearest.back_gap_m, nearest.back_rate_mps) =
      std::min(std::pair(one.back_gap_m, one.back_rate_mps),
               std::pair(nearest.back_gap_m, nearest.back_rate_mps));
}

}  // namespace

Lanes::Lanes(const DrivingSettings& settings)
    : lanes_(settings.road.lanes),
      per_lane_(settings.planner.corridors_per_lane),
      lane_width_m_(settings.road.lane_width_m) {}

int Lanes::lane_at(double d_m) const { return strip_at(d_m, lane_width_m_, lanes_); }

int Lanes::corridor_at(double d_m) const { return strip_at(d_m, corridor_width_m(), corridors()); }

bool Lanes::fits(int corridor, double width_m, double right_edge_m, double left_edge_m) const {
  constexpr double kRounding_m = 1e-9;
  const double centre_m = corridor_centre_m(corridor);
  return centre_m - width_m / 2 >= right_edge_m - kRounding_m &&
         centre_m + width_m / 2 <= left_edge_m + kRounding_m;
}

std::vector<CorridorGaps> corridor_gaps(const Scene& scene, const DrivingSettings& settings) {
  const Lanes lanes(settings);
  const double half_swath_m = settings.ego.width_m / 2 + settings.planner.side_clearance_m;
  // Corridor c's centre is (c + 0.5) corridor widths from the right edge; inverted, it tells which
  // corridors' centres lie less than half a swath from a vehicle's sides.
  const auto corridor_coordinate = [&](double d_m) { return d_m / lanes.corridor_width_m() - 0.5; };

  std::vector<CorridorGaps> gaps(static_cast<std::size_t>(lanes.corridors()),
                                 free_road(settings.planner));
  for (const Vehicle& other : scene.others) {
    const double drift_m = other.lateral_speed_mps * settings.planner.look_ahead_s;
    const double right_m = other.d_m - other.width_m / 2 + std::min(0.0, drift_m);
    const double left_m = other.d_m + other.width_m / 2 + std::max(0.0, drift_m);
    const int first = static_cast<int>(std::floor(corridor_coordinate(right_m - half_swath_m))) + 1;
    const int last = static_cast<int>(std::ceil(corridor_coordinate(left_m + half_swath_m))) - 1;
    const CorridorGaps one = gaps_to(other, scene.ego, settings);
    for (int c = std::max(0, first); c <= std::min(last, lanes.corridors() - 1); ++c)
      keep_nearest(one, gaps[static_cast<std::size_t>(c)]);
  }
  return gaps;
}

CorridorGaps lane_gaps(const Scene& scene, int lane, const DrivingSettings& settings) {
  const Lanes lanes(settings);
  if (lane < 0 || lane >= lanes.lanes()) return {};
  const double right_m = lane * lanes.lane_width_m();
  const double left_m = right_m + lanes.lane_width_m();
  CorridorGaps gaps = free_road(settings.planner);
  for (const Vehicle& other : scene.others) {
    const bool overlaps =
        other.d_m + other.width_m / 2 > right_m && other.d_m - other.width_m / 2 < left_m;
    if (overlaps) keep_nearest(gaps_to(other, scene.ego, settings), gaps);
  }
  return gaps;
}

}  // namespace corridor::driving
