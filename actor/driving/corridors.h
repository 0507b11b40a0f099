// SPDX-License-Identifier: Apache-2.0
// Lanes cut into N_c corridors each (paper section III-C), and the gaps along them.
#pragma once

#include <vector>

#include "actor/driving/scene.h"
#include "proto/settings/settings.h"

namespace corridor::driving {

// Where corridors and lanes lie. Cheap to make; every position is clamped to the road, and one on
// the line between two lanes or corridors is in the left one.
class Lanes {
 public:
  explicit Lanes(const DrivingSettings& settings);

  int lanes() const { return lanes_; }
  int per_lane() const { return per_lane_; }
  int corridors() const { return lanes_ * per_lane_; }
  double lane_width_m() const { return lane_width_m_; }
  double corridor_width_m() const { return lane_width_m_ / per_lane_; }
  double road_width_m() const { return lanes_ * lane_width_m_; }

  int lane_at(double d_m) const;
  int corridor_at(double d_m) const;
  int lane_of(int corridor) const { return corridor / per_lane_; }
  int middle_of_lane(int lane) const { return lane * per_lane_ + per_lane_ / 2; }
  double lane_centre_m(int lane) const { return (lane + 0.5) * lane_width_m_; }
  double corridor_centre_m(int corridor) const { return (corridor + 0.5) * corridor_width_m(); }
  // Whether a body of this width, in the middle of the corridor, is between the two edges; touching
  // them is allowed. Corridors off the road may be asked for.
  bool fits(int corridor, double width_m, double right_edge_m, double left_edge_m) const;

 private:
  int lanes_;
  int per_lane_;
  double lane_width_m_;
};

// The free road along one corridor, bumper to bumper, for a swath as wide as the ego plus
// side_clearance_m on each side. Without a vehicle in range: the gap is gap_range_m, the rate 0.
// A vehicle beside the ego makes both gaps 0. Of several vehicles equally near, the one closing
// fastest counts.
struct CorridorGaps {
  double front_gap_m = 0.0;
  double front_rate_mps = 0.0;  // leader's speed minus ego speed: < 0 when closing
  double back_gap_m = 0.0;
  double back_rate_mps = 0.0;  // ego speed minus follower's: < 0 when closing
};

// One entry a corridor of the road, from the right: [lanes * N_c]. A vehicle occupies the corridors
// that it overlaps now or will reach within look_ahead_s at its lateral speed.
std::vector<CorridorGaps> corridor_gaps(const Scene& scene, const DrivingSettings& settings);

// The nearest vehicles in one lane, for the behaviour planner: those whose body overlaps the lane,
// the same gaps and rates and range as above. A lane that does not exist has gaps 0.
CorridorGaps lane_gaps(const Scene& scene, int lane, const DrivingSettings& settings);

}  // namespace corridor::driving
