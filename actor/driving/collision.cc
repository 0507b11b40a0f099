// SPDX-License-Identifier: Apache-2.0
#include "actor/driving/collision.h"

#include <algorithm>
#include <cmath>

namespace corridor::driving {
namespace {

bool overlap_along(const Ego& ego, const Vehicle& other, const EgoSettings& size) {
  return other.s_m - other.length_m < ego.s_m && ego.s_m - size.length_m < other.s_m;
}

// Two rectangles are apart when a line along one's side lies between them; here the lines along the
// turned one's sides. Half lengths and widths, from the middle.
bool overlap_turned(const Ego& ego, const Vehicle& other, const EgoSettings& size) {
  const double cos = std::cos(ego.yaw_rad), sin = std::sin(ego.yaw_rad);
  // The ego's middle lies half its length behind its front bumper, along its yaw.
  const double ahead_m = other.s_m - other.length_m / 2 - (ego.s_m - cos * size.length_m / 2);
  const double left_m = other.d_m - (ego.d_m - sin * size.length_m / 2);
  const double half_m[] = {size.length_m / 2, size.width_m / 2};
  const double other_half_m[] = {other.length_m / 2, other.width_m / 2};
  const double abs_cos = std::abs(cos), abs_sin = std::abs(sin);
  return std::abs(ahead_m) < other_half_m[0] + half_m[0] * abs_cos + half_m[1] * abs_sin &&
         std::abs(left_m) < other_half_m[1] + half_m[0] * abs_sin + half_m[1] * abs_cos &&
         std::abs(cos * ahead_m + sin * left_m) <
             half_m[0] + other_half_m[0] * abs_cos + other_half_m[1] * abs_sin &&
         std::abs(-sin * ahead_m + cos * left_m) <
             half_m[1] + other_half_m[0] * abs_sin + other_half_m[1] * abs_cos;
}

bool overlap(const Ego& ego, const Vehicle& other, const EgoSettings& size) {
  if (ego.yaw_rad != 0.0) return overlap_turned(ego, other, size);
  return overlap_along(ego, other, size) && overlap_across(ego, other, size);
}

CollisionKind rear_collision(const Ego& ego, const Vehicle& other) {
  return other.s_m < ego.s_m ? CollisionKind::kRearEnded : CollisionKind::kRearEnding;
}

// Both in the same unit, > 0 towards each other.
CollisionKind side_collision(double ego_approach, double other_approach) {
  return other_approach > ego_approach ? CollisionKind::kSideByOther : CollisionKind::kSideByEgo;
}

CollisionKind kind_of(const Scene& before, const Scene& after, const Vehicle& other,
                      const EgoSettings& size) {
  if (const Vehicle* earlier = find_vehicle(before, other.id)) {
    // Who is behind is asked one step earlier too: in a fast approach the front bumper of whoever
    // runs into the other may by now be the one further ahead.
    if (overlap_across(before.ego, *earlier, size)) return rear_collision(before.ego, *earlier);
    const double to_ego = std::copysign(1.0, before.ego.d_m - earlier->d_m);
    return side_collision(-to_ego * (after.ego.d_m - before.ego.d_m),
                          to_ego * (other.d_m - earlier->d_m));
  }
  const double to_ego = std::copysign(1.0, after.ego.d_m - other.d_m);
  const double other_approach_mps = to_ego * other.lateral_speed_mps;
  const double ego_approach_mps = -to_ego * after.ego.lateral_speed_mps;
  if (std::max(other_approach_mps, ego_approach_mps) <= 0.0)
    return rear_collision(after.ego, other);
  return side_collision(ego_approach_mps, other_approach_mps);
}

}  // namespace

bool overlap_across(const Ego& ego, const Vehicle& other, const EgoSettings& size) {
  return std::abs(ego.d_m - other.d_m) < (size.width_m + other.width_m) / 2;
}

std::optional<Collision> find_collision(const Scene& before, const Scene& after,
                                        const EgoSettings& ego) {
  for (const Vehicle& other : after.others) {
    if (overlap(after.ego, other, ego))
      return Collision{kind_of(before, after, other, ego), other.id};
  }
  return std::nullopt;
}

}  // namespace corridor::driving
