// SPDX-License-Identifier: Apache-2.0
// The World that SUMO simulates. The only user of libsumo.
//
// The ego moves along its trajectories as [dynamics] says, or SUMO drives it; SUMO drives all
// others. One step costs about 0.1 ms with 15 vehicles, `begin` about 5 ms and a few KB that
// libsumo leaks.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "actor/world/ego_motion.h"
#include "actor/world/traffic.h"
#include "actor/world/world.h"
#include "proto/settings/settings.h"
#include "proto/system/files.h"
#include "proto/system/time_account.h"

namespace corridor::world {

// What the world needs to know, and no more.
struct WorldSettings {
  RoadSettings road;
  SimulationSettings simulation;
  TrafficSettings traffic;
  EgoSettings ego;
  DynamicsSettings dynamics;
};

inline WorldSettings world_settings(const RunConfig& config) {
  return {config.road, config.simulation, config.traffic, config.ego, config.dynamics};
}

class SumoWorld : public World {
 public:
  // `network` and `vehicle_types` as scenarios/sumo_files.h makes them. At most one SumoWorld
  // exists in a process (CHECK): libsumo has one simulation. `time` outlives the world. Throws
  // Failure when the road is too short for an episode or a file is missing.
  SumoWorld(const WorldSettings& settings, std::filesystem::path network,
            std::filesystem::path vehicle_types, TimeAccount& time);
  ~SumoWorld() override;
  SumoWorld(const SumoWorld&) = delete;
  SumoWorld& operator=(const SumoWorld&) = delete;

  driving::Scene begin(const EpisodeStart& start) override;
  StepResult step(const driving::Trajectory& trajectory) override;
  StepResult step_by_world() override;
  driving::Scene take_over() override;
  // Throws Failure when SUMO could not write all of the episode's trajectories.
  void end() override;

 private:
  std::vector<std::string> options(const EpisodeStart& start) const;
  TrafficScenario traffic_scenario(const EpisodeStart& start) const;
  void add_ego(const driving::Ego& ego, EgoDriver driver);
  void add(const Entrance& entrance);
  void apply(const TrafficChange& change);
  void read_others();
  void put_objects_to_the_edge();
  void place(const driving::Ego& ego);
  void place_ghost(const driving::Ego& ego);
  void simulate();
  StepResult finish_substep(const Motion& after);

  WorldSettings settings_;
  std::filesystem::path network_;
  std::filesystem::path vehicle_types_;
  // As SUMO's options are given them.
  PlainlyNamedFolder network_folder_;
  PlainlyNamedFolder vehicle_types_folder_;
  TimeAccount& time_;

  // Of the episode in progress.
  bool running_ = false;
  std::filesystem::path fcd_output_;  // empty: none
  std::optional<PlainlyNamedFolder> fcd_folder_;
  EgoDriver driver_ = EgoDriver::kPlanner;
  std::uint64_t seed_ = 0;
  std::function<void(const driving::Scene&)> watch_;
  std::unique_ptr<EgoMotion> motion_;
  double right_edge_y_m_ = 0.0;  // SUMO's y of the road's right edge; d = y - this
  std::optional<Traffic> traffic_;
  driving::Scene scene_;
  std::vector<driving::Vehicle> new_objects_;  // since the last step
  std::optional<int> ghost_lane_;              // where the ghost is
  int ghosts_ = 0;                             // so far
};

}  // namespace corridor::world
