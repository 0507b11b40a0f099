// SPDX-License-Identifier: Apache-2.0
// A world without a simulator, for tests of what drives in one: vehicles at constant speed, drawn
// from the episode's seed; the ego follows its trajectories exactly.
#pragma once

#include <optional>
#include <utility>

#include "actor/driving/collision.h"
#include "actor/driving/corridors.h"
#include "actor/world/world.h"
#include "proto/base/random.h"
#include "proto/settings/settings.h"

namespace corridor::testing_support {

class FakeWorld : public world::World {
 public:
  explicit FakeWorld(const RunConfig& config, int vehicles = 8)
      : config_(config), vehicles_(vehicles), lanes_(driving_settings(config)) {}

  driving::Scene begin(const world::EpisodeStart& start) override {
    ++episodes_begun;
    traffic = start.traffic;
    scene_ = {};
    scene_.ego.s_m = 500.0;
    scene_.ego.d_m = lanes_.lane_centre_m(1);
    scene_.ego.speed_mps = scene_.ego.set_point_mps = 10.0;
    for (int i = 0; i < vehicles_; ++i) {
      const auto draw = [&](std::uint64_t which) {
        return random_unit(start.seed, Purpose::kTraffic, {static_cast<std::uint64_t>(i), which});
      };
      driving::Vehicle vehicle;
      vehicle.id = i;
      vehicle.s_m = scene_.ego.s_m + 15.0 + 100.0 * draw(0);
      vehicle.d_m = lanes_.lane_centre_m(static_cast<int>(3 * draw(1)));
      vehicle.speed_mps = 5.0 + 6.0 * draw(2);
      scene_.others.push_back(vehicle);
    }
    return scene_;
  }

  world::StepResult step(const driving::Trajectory& trajectory) override {
    const driving::TrajectoryPoint point = trajectory.at(config_.simulation.step_s);
    const double acceleration_mps2 =
        (point.speed_mps - scene_.ego.speed_mps) / config_.simulation.step_s;
    return advance({point.s_m, point.d_m, point.speed_mps, acceleration_mps2,
                    point.lateral_speed_mps, trajectory.target().set_point_mps});
  }

  world::StepResult step_by_world() override {
    driving::Ego ego = scene_.ego;
    ego.s_m += ego.speed_mps * config_.simulation.step_s;
    return advance(ego);
  }

  driving::Scene take_over() override {
    scene_.ego.set_point_mps = scene_.ego.speed_mps;
    return scene_;
  }

  void end() override {}

  int episodes_begun = 0;
  std::optional<TrafficSettings> traffic;  // of the last start

 private:
  world::StepResult advance(const driving::Ego& ego) {
    const driving::Scene before = scene_;
    scene_.ego = ego;
    for (auto& vehicle : scene_.others)
      vehicle.s_m += vehicle.speed_mps * config_.simulation.step_s;
    return {scene_, ego, ego, driving::find_collision(before, scene_, config_.ego)};
  }

  RunConfig config_;
  int vehicles_;
  driving::Lanes lanes_;
  driving::Scene scene_;
};

}  // namespace corridor::testing_support
