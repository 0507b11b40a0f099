// The worlds in which the same planners can drive: what moves the ego along its trajectories.
#pragma once

#include <vector>

namespace corridor {

struct WorldKind {
  const char* name;
  const char* meaning;
};

inline constexpr WorldKind kWorlds[] = {
    {"kinematic", "the ego is where its trajectory says"},
    {"webots", "a car that ODE simulates, on the tyres of Webots' highway world; 10 ms"},
    {"slip", "the same car on tyres that slip, of dynamics.friction; 2 ms"},
};

inline std::vector<const char*> world_names() {
  std::vector<const char*> names;
  for (const WorldKind& world : kWorlds) names.push_back(world.name);
  return names;
}

}  // namespace corridor
