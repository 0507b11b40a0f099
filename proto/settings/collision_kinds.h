// SPDX-License-Identifier: Apache-2.0
// Who ran into whom: as driving tells it, and as records and tables name it.
#pragma once

#include <array>
#include <cstddef>

#include "proto/settings/choices.h"

namespace corridor {

enum class CollisionKind { kRearEnded, kRearEnding, kSideByOther, kSideByEgo, kOffRoad };
template <>
inline constexpr auto kChoices<CollisionKind> = std::to_array<Choice<CollisionKind>>({
    {CollisionKind::kRearEnded, "rear_ended", "another vehicle ran into the ego from behind"},
    {CollisionKind::kRearEnding, "rear_ending", "the ego ran into another vehicle"},
    {CollisionKind::kSideByOther, "side_by_other", "another vehicle moved sideways into the ego"},
    {CollisionKind::kSideByEgo, "side_by_ego", "the ego moved sideways into another vehicle"},
    {CollisionKind::kOffRoad, "off_road",
     "the ego's middle left the road: where a car has dynamics of its own"},
});
inline constexpr std::size_t kCollisionKinds = kChoices<CollisionKind>.size();

}  // namespace corridor
