// SPDX-License-Identifier: Apache-2.0
// Who hit whom. Rectangles along the road, the ego's turned by its yaw, tested at every step:
// SUMO's own report misses some.
#pragma once

#include <optional>

#include "actor/driving/scene.h"
#include "proto/settings/collision_kinds.h"
#include "proto/settings/settings.h"

namespace corridor::driving {

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
