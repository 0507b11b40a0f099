// Every key of a scenario file once: name, value, range, comment. Reading, checking and writing
// (proto/config/run_config.cc) are visitors of this description. Private to proto/.
//
// A visitor has, besides table(name, comment) before each table's keys:
//   number(key, value, low, high, comment)       ends included; NaN is outside
//   list(key, values, counts, low, high, comment)
//   flag(key, value, comment)
//   choice(key, value, choices, comment)
//   text(key, value, comment)
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "proto/settings/settings.h"
#include "proto/settings/worlds.h"

namespace corridor::config_keys {

struct Count {
  std::size_t low = 0;
  std::size_t high = 0;
};

inline constexpr std::int64_t kStepsMax = 10'000'000'000;
// TOML's largest integer less one: the largest is what the TOML library makes of still larger ones.
inline constexpr std::uint64_t kSeedMax = std::numeric_limits<std::int64_t>::max() - 1;
// With three corridor changes and three commands each, an action still fits a byte
// (actor/driving/action.h).
inline constexpr std::size_t kSpeedChangesMax = 28;

template <typename Visitor>
void describe(RoadSettings& road, Visitor& v) {
  v.table("road", "One straight edge. Lanes count from the right, 0 first.");
  v.number("lanes", road.lanes, 1, 8, "");
  v.number("lane_width_m", road.lane_width_m, 2.0, 6.0,
           "a multiple of simulation.lateral_resolution_m");
  v.number("length_m", road.length_m, 100.0, 1e6, "an episode at the speed limit must fit");
  v.number("speed_limit_mps", road.speed_limit_mps, 1.0, 70.0, "");
}

template <typename Visitor>
void describe(SimulationSettings& simulation, Visitor& v) {
  v.table("simulation", "SUMO and the clock of both planners.");
  v.number("step_s", simulation.step_s, 0.05, 2.0, "");
  v.number("substeps", simulation.substeps, 1, 100, "of SUMO and the ego's motion in each step");
  v.number("episode_steps", simulation.episode_steps, 1, 100'000,
           "an episode ends by a collision or after so many");
  v.number("lateral_resolution_m", simulation.lateral_resolution_m, 0.1, 6.0, "");
}

template <typename Visitor>
void describe(TrafficSettings& traffic, Visitor& v) {
  v.table("traffic", "A treadmill: the traffic near the ego is kept up around it.");
  v.number("window_m", traffic.window_m, 20.0, 1000.0, "from the ego, to the front and the back");
  v.number("vehicles_min", traffic.vehicles_min, 0, 200, "in the window, drawn once an episode");
  v.number("vehicles_max", traffic.vehicles_max, 0, 200, "");
  v.number("slow_share", traffic.slow_share, 0.0, 1.0, "of the vehicles: slow cars");
  v.number("slow_speed_factor", traffic.slow_speed_factor, 0.05, 2.0, "");
  v.number("truck_share", traffic.truck_share, 0.0, 1.0, "of the vehicles: trucks");
  v.number("truck_speed_factor", traffic.truck_speed_factor, 0.05, 2.0, "");
  v.number("speed_factor_mean", traffic.speed_factor_mean, 0.05, 2.0,
           "the other cars': normal, cut off at both ends");
  v.number("speed_factor_deviation", traffic.speed_factor_deviation, 0.0, 1.0, "");
  v.number("speed_factor_min", traffic.speed_factor_min, 0.05, 2.0, "");
  v.number("speed_factor_max", traffic.speed_factor_max, 0.05, 2.0, "");
  v.number("keep_right", traffic.keep_right, 0.0, 10.0, "SUMO's lcKeepRight");
  v.number("blind_rate_per_s", traffic.blind_rate_per_s, 0.0, 1.0,
           "neighbours that change into the ego's lane without looking");
  v.number("blind_duration_s", traffic.blind_duration_s, 0.0, 60.0, "");
  v.number("blind_range_m", traffic.blind_range_m, 0.0, 1000.0, "of the ego, along the road");
  v.number("objects_per_km", traffic.objects_per_km, 0.0, 20.0,
           "beside the vehicles: narrow objects at a lane's edge");
  v.number("object_width_m", traffic.object_width_m, 0.1, 3.0,
           "leaves the ego room to go around within the lane");
  v.number("object_length_m", traffic.object_length_m, 0.1, 20.0, "");
  v.number("object_speed_mps", traffic.object_speed_mps, 0.0, 5.0, "0: stopped");
}

template <typename Visitor>
void describe(TrafficDistribution& traffic, Visitor& v) {
  v.table("training_traffic",
          "[low, high] of what each training episode draws anew; []: as in [traffic].");
  v.list("vehicles", traffic.vehicles, Count{0, 2}, 0, 200, "");
  v.list("slow_share", traffic.slow_share, Count{0, 2}, 0.0, 1.0, "");
  v.list("speed_factor_mean", traffic.speed_factor_mean, Count{0, 2}, 0.05, 2.0, "");
  v.list("blind_rate_per_s", traffic.blind_rate_per_s, Count{0, 2}, 0.0, 1.0, "");
  v.list("objects_per_km", traffic.objects_per_km, Count{0, 2}, 0.0, 20.0, "");
}

template <typename Visitor>
void describe(EgoSettings& ego, Visitor& v) {
  v.table("ego", "The car that is driven, and its kinematic limits.");
  v.number("length_m", ego.length_m, 1.0, 20.0, "");
  v.number("width_m", ego.width_m, 0.5, 3.0, "");
  v.number("acceleration_max_mps2", ego.acceleration_max_mps2, 0.1, 20.0, "");
  v.number("deceleration_max_mps2", ego.deceleration_max_mps2, 0.1, 20.0, "");
}

template <typename Visitor>
void describe(DynamicsSettings& dynamics, Visitor& v) {
  v.table("dynamics", "How the ego gets along its trajectories.");
  v.choice("world", dynamics.world, world_names(), "kinematic: exactly");
  v.choice("car", dynamics.car, {"bmw_x5", "toyota_prius"}, "that ODE simulates");
  v.number("friction", dynamics.friction, 0.1, 1.5, "of slip tyres: 0.9 dry, 0.5 wet, 0.3 snow");
  v.number("actuation_delay_s", dynamics.actuation_delay_s, 0.0, 1.0, "a multiple of 0.05");
  v.number("position_noise_m", dynamics.position_noise_m, 0.0, 5.0,
           "standard deviation of what is measured of the ego");
  v.number("speed_noise_mps", dynamics.speed_noise_mps, 0.0, 5.0, "");
  v.flag("ghost", dynamics.ghost, "traffic meets a vehicle where the ego intrudes on a lane");
}

template <typename Visitor>
void describe(PlannerSettings& planner, Visitor& v) {
  v.table("planner", "The state-action abstraction of paper section III-C.");
  v.number("corridors_per_lane", planner.corridors_per_lane, 3, 15,
           "N_c: odd, so that there is a middle");
  v.list("speed_changes_mps", planner.speed_changes_mps, Count{1, kSpeedChangesMax}, -20.0, 20.0,
         "of the set-point, ascending");
  v.number("corridor_change_s", planner.corridor_change_s, 0.1, 10.0,
           "time to move over by one corridor");
  v.number("gap_range_m", planner.gap_range_m, 10.0, 500.0, "");
  v.number("side_clearance_m", planner.side_clearance_m, 0.0, 1.0,
           "added to each side of the ego in a corridor's swath");
  v.number("look_ahead_s", planner.look_ahead_s, 0.0, 10.0,
           "others occupy what their lateral speed reaches by then");
  v.number("clearance_steps", planner.clearance_steps, 0, 10,
           "how far the MoP sees what its moves lead to; 0: not at all");
}

template <typename Visitor>
void describe(MopRewardSettings& reward, Visitor& v) {
  v.table("mop_reward", "Paper section III-C; d = headway_s * v + standstill_gap_m.");
  v.number("speed_tolerance_mps", reward.speed_tolerance_mps, 0.0, 20.0, "");
  v.number("headway_s", reward.headway_s, 0.0, 10.0, "tau");
  v.number("standstill_gap_m", reward.standstill_gap_m, 0.0, 50.0, "d0");
  v.number("near_low", reward.near_low, 0.0, 10.0,
           "the smallest front gap is near d from this * d");
  v.number("near_high", reward.near_high, 0.0, 10.0, "to this * d + near_high_offset_m");
  v.number("near_high_offset_m", reward.near_high_offset_m, 0.0, 100.0, "");
  v.number("acceleration_penalty", reward.acceleration_penalty, 0.0, 1.0, "for each m/s2");
}

template <typename Visitor>
void describe(BpRewardSettings& reward, Visitor& v) {
  v.table("bp_reward", "Paper section III-B.");
  v.list("thresholds_mps", reward.thresholds_mps, Count{1, 8}, 0.0, 70.0,
         "one a lane, from the right");
  v.number("left_change", reward.left_change, -1000.0, 1000.0, "");
  v.number("collision_shaping", reward.collision_shaping, -1000.0, 0.0,
           "in training only; not the paper's, not reported");
  v.number("lane_change_shaping", reward.lane_change_shaping, -1000.0, 0.0,
           "likewise, on a change to either side");
}

template <typename Visitor>
void describe(RulesSettings& rules, Visitor& v) {
  v.table("rules", "The rule-based planners.");
  v.number("slow_leader_mps", rules.slow_leader_mps, 0.0, 70.0,
           "leave a lane whose leader is this much below the target");
  v.number("leader_range_m", rules.leader_range_m, 0.0, 500.0,
           "leaders further away do not matter");
  v.number("gain_mps", rules.gain_mps, 0.0, 70.0,
           "a lane must promise this much more to change to it");
  v.number("front_gap_s", rules.front_gap_s, 0.0, 10.0,
           "the least gap to change into, ahead, at ego speed");
  v.number("back_gap_s", rules.back_gap_s, 0.0, 10.0, "and behind, at the follower's speed");
  v.number("gap_min_m", rules.gap_min_m, 0.0, 100.0, "");
  v.number("return_right_s", rules.return_right_s, 0.0, 60.0,
           "go back right when nothing is nearer ahead than this");
}

template <typename Visitor>
void describe(RandomBpSettings& bp, Visitor& v) {
  v.table("random_bp", "The behaviour planner that asks while the MoP is trained (III-D).");
  v.number("hold_steps_min", bp.hold_steps_min, 1, 100'000, "between two lane changes");
  v.number("hold_steps_max", bp.hold_steps_max, 1, 100'000, "");
  v.number("flicker_share", bp.flicker_share, 0.0, 1.0,
           "of the periods: short random commands, as a trained BP's");
  v.number("flicker_steps", bp.flicker_steps, 1, 100'000, "length of such a period");
  v.number("flicker_hold_max", bp.flicker_hold_max, 1, 100'000, "longest command in it");
}

template <typename Visitor>
void describe_training(DqnSettings& dqn, Visitor& v) {
  v.number("steps", dqn.steps, 1, kStepsMax, "of the environment, all actors together");
  v.list("hidden", dqn.hidden, Count{1, 8}, 1, 4096, "widths of the hidden layers");
  v.flag("dueling", dqn.dueling, "value and advantages apart");
  v.flag("double_q", dqn.double_q, "double Q-learning");
  v.number("gamma", dqn.gamma, 0.0, 0.99999, "");
  v.number("n_step", dqn.n_step, 1, 100, "");
  v.number("reward_scale", dqn.reward_scale, 1e-6, 1e6, "");
  v.number("risk_weight", dqn.risk_weight, 0.0, 1e6,
           "of the discounted cost of collisions, which a second network learns; 0: none");
  v.number("risk_gamma", dqn.risk_gamma, 0.0, 0.99999, "its discount factor");
  v.number("batch_size", dqn.batch_size, 1, 65'536, "");
  v.number("samples_per_insert", dqn.samples_per_insert, 0.001, 10'000.0,
           "rows trained on for each row stored");
  v.number("target_copy_updates", dqn.target_copy_updates, 1, 10'000'000, "");
  v.number("averaging_updates", dqn.averaging_updates, 0, 10'000'000,
           "weights that drive: a running average over about so many updates; 0: none");
  v.number("learning_rate", dqn.learning_rate, 1e-12, 1.0, "falls linearly over the phase");
  v.number("learning_rate_end", dqn.learning_rate_end, 0.0, 1.0, "");
  v.number("adam_epsilon", dqn.adam_epsilon, 1e-15, 1.0, "");
  v.number("huber_delta", dqn.huber_delta, 1e-6, 1e6, "");
  v.number("gradient_norm_max", dqn.gradient_norm_max, 1e-6, 1e9, "");
}

template <typename Visitor>
void describe_exploration(DqnSettings& dqn, Visitor& v) {
  v.number("epsilon", dqn.epsilon, 0.0, 1.0, "exploration, linear to epsilon_end");
  v.number("epsilon_end", dqn.epsilon_end, 0.0, 1.0, "");
  v.number("epsilon_steps", dqn.epsilon_steps, 1, kStepsMax, "of the phase, all actors together");
  v.number("epsilon_ladder", dqn.epsilon_ladder, 0.0, 100.0,
           "actor i of N ends at epsilon_end^(1 + this * i / (N - 1))");
  v.number("exploration_hold_max", dqn.exploration_hold_max, 1, 1000,
           "exploratory actions are held 1 to so many steps");
}

template <typename Visitor>
void describe_replay(DqnSettings& dqn, Visitor& v) {
  v.number("capacity", dqn.capacity, 1, 100'000'000, "rows in the replay");
  v.number("minimum_size", dqn.minimum_size, 1, 100'000'000, "rows before training begins");
  v.number("priority_exponent", dqn.priority_exponent, 0.0, 1.0, "alpha; 0: uniform");
  v.number("importance_exponent", dqn.importance_exponent, 0.0, 1.0, "beta, rises linearly");
  v.number("importance_exponent_end", dqn.importance_exponent_end, 0.0, 1.0, "");
  v.number("priority_offset", dqn.priority_offset, 1e-9, 1e3,
           "added to |TD error|, so that nothing is never drawn");
}

template <typename Visitor>
void describe(DqnSettings& dqn, const char* table, const char* comment, Visitor& v) {
  v.table(table, comment);
  describe_training(dqn, v);
  describe_exploration(dqn, v);
  describe_replay(dqn, v);
}

template <typename Visitor>
void describe(ScheduleSettings& schedule, Visitor& v) {
  v.table("schedule", "Rounds, evaluation during training, checkpoints.");
  v.number("steps_per_round", schedule.steps_per_round, 1, 65'536, "of each actor: one chunk");
  v.number("selection_every_steps", schedule.selection_every_steps, 1, kStepsMax,
           "greedy evaluation; all actors together");
  v.number("selection_episodes", schedule.selection_episodes, 1, 10'000,
           "on seeds of its own, the same each time");
  v.number("selection_collision_cost", schedule.selection_collision_cost, 0.0, 1e6,
           "best = reward - this * collisions, per 1000 steps");
  v.choice("mop_commands", schedule.mop_commands, {"random", "learned"},
           "the BP that asks while the MoP is trained; learned: needs train --from");
  v.number("checkpoint_every_steps", schedule.checkpoint_every_steps, 1, kStepsMax, "");
  v.number("checkpoints_kept", schedule.checkpoints_kept, 1, 1000, "");
}

template <typename Visitor>
void describe(EvaluationSettings& evaluation, Visitor& v) {
  v.table("evaluation", "What `corridor evaluate` does unless told otherwise.");
  v.number("steps", evaluation.steps, 1, kStepsMax, "for each planner pair and seed");
  v.list("seeds", evaluation.seeds, Count{1, 1000}, 0, kSeedMax, "");
}

template <typename Visitor>
void describe(RunSettings& run, Visitor& v) {
  v.table("run", "Where, with how many, and how long to wait.");
  v.number("seed", run.seed, 0, kSeedMax, "");
  v.number("actors", run.actors, 1, 1024, "");
  v.choice("device", run.device, {"cpu", "cuda"}, "of the learner: cpu or cuda");
  v.choice("transport", run.transport, {"ipc", "tcp"}, "ipc: on one machine, no ports; or tcp");
  v.text("host", run.host, "of replay and learner, for tcp");
  v.number("replay_port", run.replay_port, 1, 65'535, "");
  v.number("learner_port", run.learner_port, 1, 65'535, "");
  v.number("peer_timeout_s", run.peer_timeout_s, 0.1, 86'400.0,
           "a peer silent for so long is lost");
  v.number("delay_ms_max", run.delay_ms_max, 0.0, 10'000.0,
           "tests: processes sleep at random up to this, each round");
}

template <typename Visitor>
void describe(RunConfig& config, Visitor& v) {
  describe(config.road, v);
  describe(config.simulation, v);
  describe(config.traffic, v);
  describe(config.training_traffic, v);
  describe(config.ego, v);
  describe(config.dynamics, v);
  describe(config.planner, v);
  describe(config.mop_reward, v);
  describe(config.bp_reward, v);
  describe(config.rules, v);
  describe(config.random_bp, v);
  describe(config.dqn[0], "mop", "The motion planner's deep Q-network and its training.", v);
  describe(config.dqn[1], "bp", "The behaviour planner's, on the trained motion planner.", v);
  describe(config.schedule, v);
  describe(config.evaluation, v);
  describe(config.run, v);
}

}  // namespace corridor::config_keys
