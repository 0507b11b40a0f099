// Who hit whom. Rectangles along the road, the ego's turned by its yaw, tested at every step:
// SUMO's own report misses some.
#pragma once

#include <optional>

#include "actor/driving/scene.h"
#include "proto/settings/settings.h"

namespace corridor::driving {

enum class CollisionKind {
  kRearEnded = 0,    // another vehicle ran into the ego from behind
  kRearEnding = 1,   // the ego ran into another vehicle
  kSideByOther = 2,  // another vehicle moved sideways into the ego
  kSideByEgo = 3,    // the ego moved sideways into another vehicle
  kOffRoad = 4,      // the ego's middle left the road: where a car has dynamics of its own
};
inline constexpr int kCollisionKinds = 5;
// "rear_ended", "rear_ending", "side_by_other", "side_by_ego", "off_road"
const char* collision_kind_name(CollisionKind kind);

struct Collision {
  CollisionKind kind = CollisionKind::kRearEnded;
  int other = 0;  // id; 0 where there is none
  bool operator==(const Collision&) const = default;
};

// Whether the two would touch if one of them, along the road both, drove on far enough.
bool overlap_across(const Ego& ego, const Vehicle& other, const EgoSettings& size);

// The first (lowest id) vehicle that overlaps the ego in `after`, if any. Where the two already
// overlapped across the road one step earlier (`before`), it is a rear collision, by whoever is
// behind; otherwise a side collision, by whoever moved further towards the other across the road
// in this step (the ego, if both moved equally far). A vehicle that is not in `before` is judged by
// the two present lateral speeds: a rear collision when neither moves towards the other.
std::optional<Collision> find_collision(const Scene& before, const Scene& after,
                                        const EgoSettings& ego);

}  // namespace corridor::driving
