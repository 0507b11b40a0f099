// SPDX-License-Identifier: Apache-2.0
// What a scenario's files for SUMO call things, and by which names the world asks SUMO for them.
#pragma once

#include <array>
#include <string>

#include "proto/base/format.h"

namespace corridor {

inline constexpr const char* kSumoNetworkFile = "road.net.xml";
inline constexpr const char* kSumoRoutesFile = "traffic.rou.xml";

inline constexpr const char* kSumoRoad = "road";  // the one edge, and the route along it
inline std::string sumo_lane(int lane) { return fmt::format("{}_{}", kSumoRoad, lane); }

// Vehicle types: the ego, the part of it that reaches into a lane beside, and what stands around.
inline constexpr const char* kEgoType = "ego";
inline constexpr const char* kGhostType = "ghost";
inline constexpr const char* kObjectType = "object";

// Of the other vehicles the kind fixes size and speed, the alignment where in its lane a driver
// keeps (SUMO's latAlignment).
enum class VehicleKind { kCar = 0, kSlow = 1, kTruck = 2 };
inline constexpr std::array kVehicleKinds = {"car", "slow", "truck"};
inline constexpr std::array kAlignments = {"center", "arbitrary", "right", "left"};
inline std::string vehicle_type(VehicleKind kind, const char* alignment) {
  return fmt::format("{}_{}", kVehicleKinds[static_cast<std::size_t>(kind)], alignment);
}

}  // namespace corridor
