#include "actor/driving/collision.h"

#include <algorithm>
#include <cmath>

#include "proto/failure.h"

namespace corridor::driving {
namespace {

bool overlap_along(const Ego& ego, const Vehicle& other, const EgoSettings& size) {
  return other.s_m - other.length_m < ego.s_m && ego.s_m - size.length_m < other.s_m;
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

const char* collision_kind_name(CollisionKind kind) {
  constexpr const char* kNames[kCollisionKinds] = {"rear_ended", "rear_ending", "side_by_other",
                                                   "side_by_ego"};
  const auto index = static_cast<int>(kind);
  CORRIDOR_CHECK(index >= 0 && index < kCollisionKinds, "collision kind {}", index);
  return kNames[index];
}

bool overlap_across(const Ego& ego, const Vehicle& other, const EgoSettings& size) {
  return std::abs(ego.d_m - other.d_m) < (size.width_m + other.width_m) / 2;
}

std::optional<Collision> find_collision(const Scene& before, const Scene& after,
                                        const EgoSettings& ego) {
  for (const Vehicle& other : after.others) {
    if (overlap_along(after.ego, other, ego) && overlap_across(after.ego, other, ego))
      return Collision{kind_of(before, after, other, ego), other.id};
  }
  return std::nullopt;
}

}  // namespace corridor::driving
