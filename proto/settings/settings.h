// A scenario as plain values: one struct a component, each with the defaults that work. The TOML
// file's tables and keys have the same names (proto/config/run_config.h reads, checks and writes
// them); units stand last in names. A component is handed its own structs only.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "proto/settings/named_networks.h"
#include "proto/settings/transition.h"

namespace corridor {

// [road] One straight edge. Lanes count from the right, 0 first.
struct RoadSettings {
  int lanes = 3;
  double lane_width_m = 3.2;  // a multiple of simulation.lateral_resolution_m
  double length_m = 20000.0;  // an episode at the speed limit must fit
  double speed_limit_mps = 13.89;
};

// [simulation] SUMO and the clock of both planners.
struct SimulationSettings {
  double step_s = 1.0;
  int substeps = 1;          // SUMO's, the ego's motion's, in each step of the planners
  int episode_steps = 1000;  // an episode ends by a collision or after so many steps
  double lateral_resolution_m = 0.8;

  double substep_s() const { return step_s / substeps; }
};

// [traffic] A treadmill: the traffic within `window_m` of the ego is kept up around it.
struct TrafficSettings {
  double window_m = 125.0;
  int vehicles_min = 11;  // drawn once an episode
  int vehicles_max = 13;
  double slow_share = 0.03;  // cars with speed factor `slow_speed_factor`
  double slow_speed_factor = 0.5;
  double truck_share = 0.02;
  double truck_speed_factor = 0.58;
  // The other cars' speed factor: normal, cut off at both ends.
  double speed_factor_mean = 0.8;
  double speed_factor_deviation = 0.15;
  double speed_factor_min = 0.4;
  double speed_factor_max = 1.15;
  double keep_right = 0.0;  // SUMO's lcKeepRight
  // Blind drivers: a neighbour of the ego that changes into its lane without looking. SUMO's own
  // drivers almost never hit the ego; those of the paper did.
  double blind_rate_per_s = 0.01;
  double blind_duration_s = 4.0;
  double blind_range_m = 15.0;  // of the ego, along the road
  // Objects, beside the vehicles: narrow, at the right or left edge of a drawn lane, so that
  // whoever comes can go around without changing lane. Each 1/objects_per_km of the road has one.
  double objects_per_km = 0.0;
  double object_width_m = 0.75;  // so wide that the ego in the lane's middle would hit it
  double object_length_m = 9.0;  // so long that nobody jumps over it in one step
  double object_speed_mps = 0.0;

  // Up to where an object takes its lane: its width, and a hair's breadth that keeps it, whatever
  // the rounding, out of the next lane.
  double object_reach_m() const { return object_width_m + kObjectMargin_m; }
  static constexpr double kObjectMargin_m = 0.01;
};

// [training_traffic] What of [traffic] each training episode draws anew: [low, high], uniform;
// empty: as in [traffic]. Evaluation, that during training too, drives in [traffic] itself.
struct TrafficDistribution {
  std::vector<int> vehicles;
  std::vector<double> slow_share;
  std::vector<double> speed_factor_mean;
  std::vector<double> blind_rate_per_s;
  std::vector<double> objects_per_km;
};

// [ego] The car that is driven, and its kinematic limits.
struct EgoSettings {
  double length_m = 5.0;
  double width_m = 1.8;
  double acceleration_max_mps2 = 2.5;
  double deceleration_max_mps2 = 6.0;
};

// [dynamics] How the ego gets along its trajectories (actor/world/ego_motion.h).
inline constexpr double kControlPeriod_s = 0.05;  // of the car's controller
struct DynamicsSettings {
  std::string world = "kinematic";  // of kWorlds (proto/settings/worlds.h)
  std::string car = "bmw_x5";       // or "toyota_prius"
  double friction = 0.9;            // of slip tyres: 0.9 dry, 0.5 wet, 0.3 snow
  double actuation_delay_s = 0.0;   // from the controller's decision to its effect
  // Standard deviations of what planners and controller measure of the ego.
  double position_noise_m = 0.0;
  double speed_noise_mps = 0.0;
  // Traffic does not see what of the ego reaches into another lane: another vehicle is put there.
  bool ghost = false;
};

// [planner] The state-action abstraction of paper section III-C.
struct PlannerSettings {
  int corridors_per_lane = 5;  // N_c: odd, so that there is a middle
  std::vector<double> speed_changes_mps = {-4.0, -2.0, -1.0,
                                           0.0,  1.0,  2.0};  // of the set-point, ascending
  double corridor_change_s = 1.0;                             // time to move over by one corridor
  double gap_range_m = 100.0;
  double side_clearance_m = 0.15;  // added to each side of the ego in a corridor's swath
  double look_ahead_s = 1.0;       // others occupy what their lateral speed reaches by then
  int clearance_steps = 2;         // how far the MoP sees what its moves lead to; 0: not at all
};

// [mop_reward] Paper section III-C; d = headway_s * v + standstill_gap_m.
struct MopRewardSettings {
  double speed_tolerance_mps = 1.5;
  double headway_s = 1.2;         // tau
  double standstill_gap_m = 3.0;  // d0
  // The smallest front gap is near d when in [near_low * d, near_high * d + near_high_offset_m]. A
  // wider range leaves it to chance how far back a MoP follows (docs/results.md).
  double near_low = 0.6;
  double near_high = 1.0;
  double near_high_offset_m = 2.0;
  double acceleration_penalty = 0.05;  // for each m/s2
};

// [bp_reward] Paper section III-B.
struct BpRewardSettings {
  std::vector<double> thresholds_mps = {10.0, 11.0, 12.0};  // one a lane, from the right
  double left_change = -5.0;
  // Shaping: added in training only; not in the paper, never part of a reported reward.
  double collision_shaping = -10.0;   // on a collision
  double lane_change_shaping = -5.0;  // on a lane change, to either side
};

// [rules] The rule-based planners (actor/driving/rules_bp.h, rules_mop.h).
struct RulesSettings {
  double slow_leader_mps = 2.0;  // leave a lane whose leader is this much below the target
  double leader_range_m = 80.0;  // leaders further away do not matter
  double gain_mps = 0.25;        // a lane must promise this much more to change to it
  double front_gap_s = 0.2;      // the least gap to change into, ahead, at ego speed
  double back_gap_s = 0.2;       // and behind, at the follower's speed
  double gap_min_m = 2.5;
  double return_right_s = 2.0;  // go back right when nothing is nearer ahead than this
};

// [random_bp] The behaviour planner that asks while the MoP is trained (paper section III-D).
struct RandomBpSettings {
  int hold_steps_min = 40;  // between two lane changes
  int hold_steps_max = 160;
  double flicker_share = 0.2;  // of the periods: short random commands, as a trained BP's
  int flicker_steps = 30;      // length of such a period
  int flicker_hold_max = 4;    // longest command in it
};

// [mop], [bp] One deep Q-network and its training.
struct DqnSettings {
  std::int64_t steps = 1'000'000;  // environment steps of the phase, all actors together
  std::vector<int> hidden = {64, 64};
  bool dueling = false;
  bool double_q = true;
  double gamma = 0.97;
  int n_step = 4;
  double reward_scale = 0.03;
  // A second network of the same shape learns the risk R(s, a): the discounted cost of collisions.
  // The planner takes the action of the largest Q - risk_weight * max(0, R). 0: no second network.
  double risk_weight = 0.3;
  double risk_gamma = 0.9;
  int batch_size = 64;
  double samples_per_insert = 32.0;  // the replay ratio: rows trained on for each row stored
  int target_copy_updates = 1000;
  double learning_rate = 5e-4;  // falls linearly over the phase
  double learning_rate_end = 5e-5;
  double adam_epsilon = 1e-8;
  double huber_delta = 1.0;
  // The weights that drive are a running average of the trained ones over about the last so many
  // updates (Polyak and Juditsky 1992): a single iterate's noise makes a BP change lanes
  // needlessly. 0: the trained weights themselves.
  int averaging_updates = 2500;
  double gradient_norm_max = 10.0;
  // Exploration: linear from `epsilon` to `epsilon_end` in `epsilon_steps` (of the phase, all
  // actors together). Actor i of N ends at epsilon_end^(1 + epsilon_ladder * i / (N - 1)).
  double epsilon = 1.0;
  double epsilon_end = 0.02;
  std::int64_t epsilon_steps = 100'000;
  double epsilon_ladder = 0.4;
  int exploration_hold_max = 1;  // exploratory actions are held 1 to so many steps
  // Prioritized replay (Schaul et al. 2016).
  std::int64_t capacity = 200'000;
  std::int64_t minimum_size = 5'000;
  double priority_exponent = 0.6;    // alpha
  double importance_exponent = 0.4;  // beta, rises linearly over the phase
  double importance_exponent_end = 1.0;
  double priority_offset = 1e-3;  // added to |TD error|, so that nothing is never drawn

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

// [schedule] Rounds, evaluation during training, checkpoints (docs/architecture.md, "Lockstep").
struct ScheduleSettings {
  int steps_per_round = 256;                     // of each actor: one chunk
  std::int64_t selection_every_steps = 100'000;  // greedy evaluation; all actors together
  int selection_episodes = 16;                   // on seeds of its own, the same each time
  double selection_collision_cost = 50.0;  // best = reward - cost * collisions, per 1000 steps
  // Which BP asks while the MoP is trained: "random", or "learned", of a run that was given
  // networks.
  std::string mop_commands = "random";
  std::int64_t checkpoint_every_steps = 50'000;
  int checkpoints_kept = 2;
};

// [evaluation] What `corridor evaluate` does unless told otherwise.
struct EvaluationSettings {
  std::int64_t steps = 40'000;  // for each planner pair and seed
  std::vector<std::uint64_t> seeds = {1002};
};

// [run] Where, with how many, and how long to wait.
struct RunSettings {
  std::uint64_t seed = 1;
  int actors = 2;
  std::string device = "cpu";     // of the learner: "cpu" or "cuda"
  std::string transport = "ipc";  // "ipc": abstract Unix sockets, no files; "tcp": the ports below
  std::string host = "127.0.0.1";
  int replay_port = 5701;
  int learner_port = 5702;
  double peer_timeout_s = 30.0;  // a peer silent for so long is lost
  double delay_ms_max = 0.0;     // tests: every process sleeps at random up to this, each round
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
  PlannerShape shape(NetworkId which) const { return named_network(which).shape(*this); }
  NetworkShape network(NetworkId which) const { return phase(which).network(shape(which)); }
  // Of the reward and, where there is one, of the risk, one after the other.
  std::size_t parameters(NetworkId which) const {
    return static_cast<std::size_t>(phase(which).networks()) * network(which).parameters();
  }
};

// What actor/driving needs to know, and no more.
struct DrivingSettings {
  RoadSettings road;
  EgoSettings ego;
  PlannerSettings planner;
  MopRewardSettings mop_reward;
  BpRewardSettings bp_reward;
  RulesSettings rules;
  RandomBpSettings random_bp;
  double step_s = 1.0;
};

inline DrivingSettings driving_settings(const RunConfig& config) {
  return {config.road,      config.ego,   config.planner,   config.mop_reward,
          config.bp_reward, config.rules, config.random_bp, config.simulation.step_s};
}

}  // namespace corridor
