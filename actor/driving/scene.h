// SPDX-License-Identifier: Apache-2.0
// What the planners see of the road at one instant: the ego and the vehicles around it, in the
// Frenet frame of the road. Plain values.
//
// s runs along the road, d across it from the right edge (0) to the left; a vehicle's position is
// the middle of its front bumper. Lanes and corridors count from the right, 0 first.
#pragma once

#include <algorithm>
#include <vector>

namespace corridor::driving {

struct Vehicle {
  int id = 0;  // unique in an episode, never reused in it
  double s_m = 0.0;
  double d_m = 0.0;
  double speed_mps = 0.0;
  double lateral_speed_mps = 0.0;  // > 0 to the left
  double length_m = 5.0;
  double width_m = 1.8;
  bool operator==(const Vehicle&) const = default;
};

struct Ego {
  double s_m = 0.0;
  double d_m = 0.0;
  double speed_mps = 0.0;
  double acceleration_mps2 = 0.0;  // over the last step
  double lateral_speed_mps = 0.0;  // over the last step
  double set_point_mps = 0.0;      // the MoP's speed set-point
  // Of a car with dynamics of its own; 0 where it has none.
  double yaw_rad = 0.0;  // > 0 to the left
  double lateral_acceleration_mps2 = 0.0;
  bool operator==(const Ego&) const = default;
};

struct Scene {
  Ego ego;
  std::vector<Vehicle> others;  // ascending by id
  bool operator==(const Scene&) const = default;
};

// Null when it is not there (any more).
inline const Vehicle* find_vehicle(const Scene& scene, int id) {
  const auto found = std::ranges::lower_bound(scene.others, id, {}, &Vehicle::id);
  return found != scene.others.end() && found->id == id ? &*found : nullptr;
}

// What the behaviour planner asks for (paper section III-B): its action, which is a place in a
// table of skills (actor/driving/skills.h). Named are those of the paper.
enum class Command : int { kKeep = 0, kLeft = 1, kRight = 2 };

}  // namespace corridor::driving
