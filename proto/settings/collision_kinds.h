// Who ran into whom: as driving tells it, and as records and tables name it.
#pragma once

#include <array>
#include <cstddef>

namespace corridor {

enum class CollisionKind {
  kRearEnded = 0,    // another vehicle ran into the ego from behind
  kRearEnding = 1,   // the ego ran into another vehicle
  kSideByOther = 2,  // another vehicle moved sideways into the ego
  kSideByEgo = 3,    // the ego moved sideways into another vehicle
  kOffRoad = 4,      // the ego's middle left the road: where a car has dynamics of its own
};
inline constexpr std::array kCollisionKinds = {"rear_ended", "rear_ending", "side_by_other",
                                               "side_by_ego", "off_road"};

inline const char* name_of(CollisionKind kind) {
  return kCollisionKinds.at(static_cast<std::size_t>(kind));
}

}  // namespace corridor
