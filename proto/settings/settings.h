// SPDX-License-Identifier: Apache-2.0
// A scenario as plain values: one struct a component, each with the defaults that work. What a
// field means beyond its name and unit stands with its key: the TOML file's tables and keys have
// the same names (proto/config/config_keys.h). A component is handed its own structs only.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "proto/settings/choices.h"
#include "proto/settings/driving_settings.h"
#include "proto/settings/named_networks.h"
#include "proto/settings/transition.h"

namespace corridor {

struct SimulationSettings {
  double step_s = 1.0;
  int substeps = 1;
  int episode_steps = 1000;
  double lateral_resolution_m = 0.8;

  double substep_s() const { return step_s / substeps; }
};

struct TrafficSettings {
  double window_m = 125.0;
  int vehicles_min = 11;
  int vehicles_max = 13;
  double slow_share = 0.03;
  double slow_speed_factor = 0.5;
  double truck_share = 0.02;
  double truck_speed_factor = 0.58;
  double speed_factor_mean = 0.8;
  double speed_factor_deviation = 0.15;
  double speed_factor_min = 0.4;
  double speed_factor_max = 1.15;
  double keep_right = 0.0;
  // SUMO's own drivers almost never hit the ego; those of the paper did.
  double blind_rate_per_s = 0.01;
  double blind_duration_s = 4.0;
  double blind_range_m = 15.0;
  // Each 1/objects_per_km of the road has one, at the right or left edge of a drawn lane, so that
  // whoever comes can go around without changing lane.
  double objects_per_km = 0.0;
  double object_width_m = 0.75;  // so wide that the ego in the lane's middle would hit it
  double object_length_m = 9.0;  // so long that nobody jumps over it in one step
  double object_speed_mps = 0.0;

  // Up to where an object takes its lane: its width, and a hair's breadth that keeps it, whatever
  // the rounding, out of the next lane.
  double object_reach_m() const { return object_width_m + kObjectMargin_m; }
  static constexpr double kObjectMargin_m = 0.01;
};

// Uniform in [low, high], or as in TrafficSettings where empty. Evaluation, that during training
// too, drives in TrafficSettings itself.
struct TrafficDistribution {
  std::vector<int> vehicles;
  std::vector<double> slow_share;
  std::vector<double> speed_factor_mean;
  std::vector<double> blind_rate_per_s;
  std::vector<double> objects_per_km;
};

inline constexpr double kControlPeriod_s = 0.05;  // of the car's controller
struct DynamicsSettings {
  WorldKind world = WorldKind::kKinematic;
  Car car = Car::kBmwX5;
  double friction = 0.9;
  double actuation_delay_s = 0.0;  // from the controller's decision to its effect
  double position_noise_m = 0.0;
  double speed_noise_mps = 0.0;
  bool ghost = false;
};

// One deep Q-network and its training.
struct DqnSettings {
  std::int64_t steps = 1'000'000;
  std::vector<int> hidden = {64, 64};
  bool dueling = false;
  bool double_q = true;
  double gamma = 0.97;
  int n_step = 4;
  double reward_scale = 0.03;
  // The planner takes the action of the largest Q - risk_weight * max(0, R), R being learned by a
  // second network of the same shape.
  double risk_weight = 0.3;
  double risk_gamma = 0.9;
  int batch_size = 64;
  double samples_per_insert = 32.0;
  int target_copy_updates = 1000;
  double learning_rate = 5e-4;
  double learning_rate_end = 5e-5;
  std::int64_t annealing_steps = 0;  // 0: `steps`
  double adam_epsilon = 1e-8;
  double huber_delta = 1.0;
  // Polyak and Juditsky 1992: a single iterate's noise makes a BP change lanes needlessly.
  int averaging_updates = 2500;
  double gradient_norm_max = 10.0;
  double epsilon = 1.0;
  double epsilon_end = 0.02;
  std::int64_t epsilon_steps = 100'000;
  double epsilon_ladder = 0.4;
  int exploration_hold_max = 1;
  // Prioritized replay: Schaul et al. 2016.
  std::int64_t capacity = 200'000;
  std::int64_t minimum_size = 5'000;
  double priority_exponent = 0.6;
  double importance_exponent = 0.4;
  double importance_exponent_end = 1.0;
  double priority_offset = 1e-3;

  NetworkShape network(PlannerShape shape) const {
    return {shape.observations, hidden, shape.actions, dueling};
  }
  // For the reward, and for the risk where there is one.
  int networks() const { return risk_weight > 0.0 ? 2 : 1; }
};

// Where [bp] differs by default: it trains less, and looks further ahead.
inline DqnSettings bp_defaults() {
  DqnSettings settings;
  settings.steps = 400'000;
  settings.gamma = 0.99;
  settings.n_step = 10;  // a lane change takes five steps and pays only later
  settings.reward_scale = 0.1;
  settings.risk_gamma = 0.95;
  settings.epsilon_end = 0.01;
  settings.exploration_hold_max = 8;
  return settings;
}

struct ScheduleSettings {
  int steps_per_round = 256;
  std::int64_t selection_every_steps = 100'000;
  int selection_episodes = 16;
  double selection_collision_cost = 50.0;
  MopCommands mop_commands = MopCommands::kRandom;
  std::int64_t checkpoint_every_steps = 50'000;
  int checkpoints_kept = 2;
};

struct EvaluationSettings {
  std::int64_t steps = 40'000;
  std::vector<std::uint64_t> seeds = {1002};
};

struct RunSettings {
  std::uint64_t seed = 1;
  int actors = 2;
  Device device = Device::kCpu;
  Transport transport = Transport::kIpc;
  std::string host = "127.0.0.1";
  int replay_port = 5701;
  int learner_port = 5702;
  double peer_timeout_s = 30.0;
};

// A whole scenario. Immutable once read.
struct RunConfig {
  RoadSettings road;
  SimulationSettings simulation;
  TrafficSettings traffic;
  TrafficDistribution training_traffic;
  EgoSettings ego;
  DynamicsSettings dynamics;
  PlannerSettings planner;
  MopRewardSettings mop_reward;
  BpRewardSettings bp_reward;
  RulesSettings rules;
  RandomBpSettings random_bp;
  std::array<DqnSettings, kNetworks.size()> dqn = {DqnSettings{}, bp_defaults()};  // [mop], [bp]
  ScheduleSettings schedule;
  EvaluationSettings evaluation;
  RunSettings run;

  const DqnSettings& phase(Phase which) const { return dqn[static_cast<std::size_t>(which)]; }
  PlannerShape shape(NetworkId which) const {
    const int speed_changes = static_cast<int>(planner.speed_changes_mps.size());
    const std::array shapes = {
        mop_shape(planner.corridors_per_lane, speed_changes, planner.clearance_steps),
        bp_shape(road.lanes)};
    static_assert(shapes.size() == kNetworks.size(), "one for each");
    return shapes[static_cast<std::size_t>(which)];
  }
  NetworkShape network(NetworkId which) const { return phase(which).network(shape(which)); }
  // Of the reward and, where there is one, of the risk, one after the other.
  std::size_t parameters(NetworkId which) const {
    return static_cast<std::size_t>(phase(which).networks()) * network(which).parameters();
  }
};

inline DrivingSettings driving_settings(const RunConfig& config) {
  return {config.road,      config.ego,   config.planner,   config.mop_reward,
          config.bp_reward, config.rules, config.random_bp, config.simulation.step_s};
}

}  // namespace corridor
