// SPDX-License-Identifier: Apache-2.0
// A world in which one car is driven through traffic, one step at a time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

#include "actor/driving/collision.h"
#include "actor/driving/scene.h"
#include "actor/driving/trajectory.h"
#include "proto/settings/settings.h"

namespace corridor::world {

enum class EgoDriver {
  kPlanner,  // the ego follows the trajectories it is given
  kWorld,    // the world's own driver model drives the ego: a baseline
};

struct EpisodeStart {
  std::uint64_t seed = 0;  // all that is random in the episode follows from it
  EgoDriver driver = EgoDriver::kPlanner;
  std::filesystem::path fcd_output{};  // SUMO's own record of every vehicle's motion; empty: none
  std::optional<TrafficSettings> traffic{};            // the episode's own, in place of the world's
  std::function<void(const driving::Scene&)> watch{};  // sees every substep; none: nobody does
};

struct StepResult {
  driving::Scene scene;
  driving::Ego measured;   // the ego as planners see it
  driving::Ego reference;  // where the next trajectory is to start (world/ego_motion.h)
  std::optional<driving::Collision> collision;
};

// One thread owns it. Throws Failure when the simulator cannot be started or dies on its input.
class World {
 public:
  virtual ~World() = default;

  // Ends the episode in progress, if any, and begins another: an equal start and equal trajectories
  // give bit-identical scenes, in any process, whatever happened before.
  virtual driving::Scene begin(const EpisodeStart& start) = 0;

  // One time step along `trajectory` (ignored where the world drives). The ego's set_point_mps is
  // the trajectory's target's, or 0 where the world drives.
  virtual StepResult step(const driving::Trajectory& trajectory) = 0;
  virtual StepResult step_by_world() = 0;

  // From here on the ego follows trajectories, in an episode that the world has driven so far. The
  // scene is as it was, with the ego's speed (at most the speed limit) as its set-point.
  virtual driving::Scene take_over() = 0;

  // Ends the episode in progress, so that its files are complete.
  virtual void end() = 0;
};

}  // namespace corridor::world
