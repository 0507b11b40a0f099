// SPDX-License-Identifier: Apache-2.0
// Scenes for the driving tests: by hand, and drawn from counters.
#pragma once

#include <cstdint>
#include <vector>

#include "actor/driving/corridors.h"
#include "actor/driving/planner.h"
#include "actor/driving/scene.h"
#include "proto/base/random.h"
#include "proto/settings/settings.h"

namespace corridor::driving {

// Three lanes of 3.2 m, five corridors of 0.64 m each, whose centres are 0.32, 0.96, 1.6, ...
inline const DrivingSettings kSettings = driving_settings(RunConfig{});

// In the middle of lane 1 (d = 4.8 m, corridor 7), front bumper at s = 100 m, at 10 m/s.
inline Ego ego_in_the_middle() {
  return {.s_m = 100.0, .d_m = 4.8, .speed_mps = 10.0, .set_point_mps = 10.0};
}

inline Ego ego_at(double d_m, double speed_mps) {
  return {.s_m = 100.0, .d_m = d_m, .speed_mps = speed_mps, .set_point_mps = speed_mps};
}

inline Ego ego_in_corridor(int corridor) {
  return {.d_m = Lanes(kSettings).corridor_centre_m(corridor), .speed_mps = 10.0};
}

class Draws {
 public:
  explicit Draws(std::uint64_t seed) : seed_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * random_unit(seed_, Purpose::kTraffic, {next_++});
  }
  int below(int bound) {
    return static_cast<int>(
        random_below(static_cast<std::uint64_t>(bound), seed_, Purpose::kTraffic, {next_++}));
  }

 private:
  std::uint64_t seed_;
  std::uint64_t next_ = 0;
};

// An ego anywhere on the road among 15 vehicles within 150 m, some of which may overlap.
inline Scene random_scene(std::uint64_t seed, const DrivingSettings& settings) {
  Draws draws(seed);
  const double road_m = Lanes(settings).road_width_m();
  const double limit_mps = settings.road.speed_limit_mps;
  Scene scene;
  scene.ego = {.s_m = 1000.0,
               .d_m = draws.uniform(0.9, road_m - 0.9),
               .speed_mps = draws.uniform(0.0, limit_mps),
               .acceleration_mps2 = draws.uniform(-6.0, 2.5),
               .lateral_speed_mps = draws.uniform(-1.2, 1.2),
               .set_point_mps = draws.uniform(0.0, limit_mps)};
  for (int id = 0; id < 15; ++id) {
    scene.others.push_back({.id = id,
                            .s_m = 1000.0 + draws.uniform(-150.0, 150.0),
                            .d_m = draws.uniform(0.9, road_m - 0.9),
                            .speed_mps = draws.uniform(0.0, 1.2 * limit_mps),
                            .lateral_speed_mps = draws.uniform(-1.5, 1.5),
                            .length_m = draws.uniform(4.0, 12.0),
                            .width_m = draws.uniform(1.6, 2.5)});
  }
  return scene;
}

inline Situation situation_of(Scene scene, const DrivingSettings& settings, int step = 0) {
  std::vector<CorridorGaps> gaps = corridor_gaps(scene, settings);
  return {std::move(scene), std::move(gaps), Command::kKeep, step};
}

}  // namespace corridor::driving
