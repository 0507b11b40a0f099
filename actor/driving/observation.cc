// SPDX-License-Identifier: Apache-2.0
#include "actor/driving/observation.h"

#include <algorithm>

#include "actor/driving/prediction.h"
#include "proto/base/failure.h"

namespace corridor::driving {
namespace {

float scaled_gap(double gap_m) {
  constexpr double kHalfWay_m = 15.0;
  return static_cast<float>(gap_m / (gap_m + kHalfWay_m));
}

float scaled_rate(double rate_mps) {
  constexpr double kFullScale_mps = 8.0;
  return static_cast<float>(std::clamp(rate_mps / kFullScale_mps, -1.0, 1.0));
}

// Both tables have the four numbers in this order.
void put_gaps(const CorridorGaps& gaps, float* front_gap) {
  front_gap[0] = scaled_gap(gaps.front_gap_m);
  front_gap[1] = scaled_rate(gaps.front_rate_mps);
  front_gap[2] = scaled_gap(gaps.back_gap_m);
  front_gap[3] = scaled_rate(gaps.back_rate_mps);
}

}  // namespace

void observe_mop(const Scene& scene, const std::vector<CorridorGaps>& gaps, const Window& window,
                 const DrivingSettings& settings, std::span<float> out) {
  const Lanes lanes(settings);
  const auto clearances_at = static_cast<std::size_t>(MopIndex::corridor(window.size()));
  const std::size_t size =
      clearances_at + static_cast<std::size_t>(kMopMoves * settings.planner.clearance_steps);
  CORRIDOR_CHECK(out.size() == size, "{} floats for {} observations", out.size(), size);
  CORRIDOR_CHECK(static_cast<int>(gaps.size()) == lanes.corridors(), "{} gaps", gaps.size());

  const Ego& ego = scene.ego;
  const double limit_mps = settings.road.speed_limit_mps;
  std::ranges::fill(out, 0.0f);
  out[MopIndex::kSpeed] = static_cast<float>(ego.speed_mps / limit_mps);
  out[MopIndex::kSetPoint] = static_cast<float>(ego.set_point_mps / limit_mps);
  out[MopIndex::kTargetSpeed] = 1.0f;  // the BP's target speed is the speed limit
  const int ego_corridor = lanes.corridor_at(ego.d_m);
  for (int position = 0; position < window.size(); ++position) {
    float* entry = &out[static_cast<std::size_t>(MopIndex::corridor(position))];
    const int corridor = window.first + position;
    if (corridor == ego_corridor) entry[MopIndex::kInCorridor] = 1.0f;
    if (window.is_open(corridor))
      put_gaps(gaps[static_cast<std::size_t>(corridor)], entry + MopIndex::kFrontGap);
  }
  std::vector<double> clearances_m(size - clearances_at);
  predicted_clearances_m(scene, settings, clearances_m);
  std::ranges::transform(clearances_m, &out[clearances_at], [](double clearance_m) {
    return static_cast<float>(std::max(-1.0, clearance_m / kClearanceMax_m));
  });
}

void observe_bp(const Scene& scene, Command previous, const DrivingSettings& settings,
                std::span<float> out, int skills) {
  const Lanes lanes(settings);
  const auto size = static_cast<std::size_t>(bp_shape(lanes.lanes(), skills).observations);
  CORRIDOR_CHECK(out.size() == size, "{} floats for {} observations", out.size(), size);

  const Ego& ego = scene.ego;
  const int own_lane = lanes.lane_at(ego.d_m);
  const auto at = [&](int index) -> float& { return out[static_cast<std::size_t>(index)]; };
  std::ranges::fill(out, 0.0f);
  at(BpIndex::kSpeed) = static_cast<float>(ego.speed_mps / settings.road.speed_limit_mps);
  at(BpIndex::kSetPoint) = static_cast<float>(ego.set_point_mps / settings.road.speed_limit_mps);
  at(BpIndex::kOffset) =
      static_cast<float>((ego.d_m - lanes.lane_centre_m(own_lane)) / (lanes.lane_width_m() / 2));
  at(BpIndex::kLane + own_lane) = 1.0f;
  at(BpIndex::previous_command(lanes.lanes()) + static_cast<int>(previous)) = 1.0f;
  for (int which = 0; which < 3; ++which) {
    const int lane = own_lane + which - 1;
    if (lane < 0 || lane >= lanes.lanes()) continue;
    float* entry = &at(BpIndex::lane(lanes.lanes(), which, skills));
    entry[BpIndex::kExists] = 1.0f;
    put_gaps(lane_gaps(scene, lane, settings), entry + BpIndex::kFrontGap);
  }
}

}  // namespace corridor::driving
