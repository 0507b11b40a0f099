// SPDX-License-Identifier: Apache-2.0
// Every key of a scenario file once: name, comment, who heeds it, value, range. Reading, writing
// and comparing (proto/config/run_config.cc) are visitors of this description. Private to proto/.
//
// A visitor has, besides table(name, comment, heeds) before each table's keys:
//   key(key, number, low, high)               ends included; NaN is outside
//   key(key, numbers, list size, low, high)   a list, each in that range
//   key(key, value)                           a flag, a word, or a choice of kChoices
#pragma once

#include <cstdint>

#include "proto/config/driving_keys.h"
#include "proto/settings/limits.h"
#include "proto/settings/settings.h"

namespace corridor::config_keys {

// Keys that there are no more. Files of earlier runs have them: what says `always`, as is always so
// now, is ignored; anything else is refused, and the advice given.
struct RetiredKey {
  const char* table;
  const char* name;
  const char* always;  // as TOML
  const char* advice;
};
inline constexpr RetiredKey kRetiredKeys[] = {
    {"run", "delay_ms_max", "0.0", "tests set CORRIDOR_TEST_DELAY_MS"},
};

template <typename Visitor>
void describe(SimulationSettings& simulation, Visitor& v) {
  v.table("simulation", "SUMO and the clock of both planners.", Heeds::kWorld);
  v.key({"step_s"}, simulation.step_s, 0.05, 2.0);
  v.key({"substeps", "of SUMO and the ego's motion in each step"}, simulation.substeps, 1, 100);
  v.key({"episode_steps", "an episode ends by a collision or after so many"},
        simulation.episode_steps, 1, 100'000);
  v.key({"lateral_resolution_m"}, simulation.lateral_resolution_m, 0.1, 6.0);
}

template <typename Visitor>
void describe(TrafficSettings& traffic, Visitor& v) {
  v.table("traffic", "A treadmill: the traffic near the ego is kept up around it.", Heeds::kWorld);
  v.key({"window_m", "from the ego, to the front and the back"}, traffic.window_m, 20.0, 1000.0);
  v.key({"vehicles_min", "in the window, drawn once an episode"}, traffic.vehicles_min, 0, 200);
  v.key({"vehicles_max"}, traffic.vehicles_max, 0, 200);
  v.key({"slow_share", "of the vehicles: slow cars"}, traffic.slow_share, 0.0, 1.0);
  v.key({"slow_speed_factor"}, traffic.slow_speed_factor, 0.05, 2.0);
  v.key({"truck_share", "of the vehicles: trucks"}, traffic.truck_share, 0.0, 1.0);
  v.key({"truck_speed_factor"}, traffic.truck_speed_factor, 0.05, 2.0);
  v.key({"speed_factor_mean", "the other cars': normal, cut off at both ends"},
        traffic.speed_factor_mean, 0.05, 2.0);
  v.key({"speed_factor_deviation"}, traffic.speed_factor_deviation, 0.0, 1.0);
  v.key({"speed_factor_min"}, traffic.speed_factor_min, 0.05, 2.0);
  v.key({"speed_factor_max"}, traffic.speed_factor_max, 0.05, 2.0);
  v.key({"keep_right", "SUMO's lcKeepRight"}, traffic.keep_right, 0.0, 10.0);
  v.key({"blind_rate_per_s", "neighbours that change into the ego's lane without looking"},
        traffic.blind_rate_per_s, 0.0, 1.0);
  v.key({"blind_duration_s"}, traffic.blind_duration_s, 0.0, 60.0);
  v.key({"blind_range_m", "of the ego, along the road"}, traffic.blind_range_m, 0.0, 1000.0);
  v.key({"objects_per_km", "beside the vehicles: narrow objects at a lane's edge"},
        traffic.objects_per_km, 0.0, 20.0);
  v.key({"object_width_m", "leaves the ego room to go around within the lane"},
        traffic.object_width_m, 0.1, 3.0);
  v.key({"object_length_m"}, traffic.object_length_m, 0.1, 20.0);
  v.key({"object_speed_mps", "0: stopped"}, traffic.object_speed_mps, 0.0, 5.0);
}

template <typename Visitor>
void describe(TrafficDistribution& traffic, Visitor& v) {
  v.table("training_traffic",
          "[low, high] of what each training episode draws anew; []: as in [traffic].",
          Heeds::kTraining);
  v.key({"vehicles"}, traffic.vehicles, ListSize{0, 2}, 0, 200);
  v.key({"slow_share"}, traffic.slow_share, ListSize{0, 2}, 0.0, 1.0);
  v.key({"speed_factor_mean"}, traffic.speed_factor_mean, ListSize{0, 2}, 0.05, 2.0);
  v.key({"blind_rate_per_s"}, traffic.blind_rate_per_s, ListSize{0, 2}, 0.0, 1.0);
  v.key({"objects_per_km"}, traffic.objects_per_km, ListSize{0, 2}, 0.0, 20.0);
}

template <typename Visitor>
void describe(DynamicsSettings& dynamics, Visitor& v) {
  v.table("dynamics", "How the ego gets along its trajectories.", Heeds::kWorld);
  v.key({"world"}, dynamics.world);
  v.key({"car", "that ODE simulates"}, dynamics.car);
  v.key({"friction", "of slip tyres: 0.9 dry, 0.5 wet, 0.3 snow"}, dynamics.friction, 0.1, 1.5);
  v.key({"actuation_delay_s", "a multiple of 0.05"}, dynamics.actuation_delay_s, 0.0, 1.0);
  v.key({"position_noise_m", "standard deviation of what is measured of the ego"},
        dynamics.position_noise_m, 0.0, 5.0);
  v.key({"speed_noise_mps", "likewise"}, dynamics.speed_noise_mps, 0.0, 5.0);
  v.key({"ghost", "traffic meets a vehicle where the ego intrudes on a lane"}, dynamics.ghost);
}

template <typename Visitor>
void describe_training(DqnSettings& dqn, Visitor& v) {
  v.key({"steps", "of the environment, all actors together"}, dqn.steps, 1, kStepsMax);
  v.key({"hidden", "widths of the hidden layers"}, dqn.hidden, ListSize{1, 8}, 1, 4096);
  v.key({"dueling", "value and advantages apart"}, dqn.dueling);
  v.key({"double_q", "double Q-learning"}, dqn.double_q);
  v.key({"gamma"}, dqn.gamma, 0.0, 0.99999);
  v.key({"n_step"}, dqn.n_step, 1, 100);
  v.key({"reward_scale"}, dqn.reward_scale, 1e-6, 1e6);
  v.key({"risk_weight",
         "of the discounted cost of collisions, which a second network learns; 0: none"},
        dqn.risk_weight, 0.0, 1e6);
  v.key({"risk_gamma", "its discount factor"}, dqn.risk_gamma, 0.0, 0.99999);
  v.key({"batch_size"}, dqn.batch_size, 1, 65'536);
  v.key({"samples_per_insert", "rows trained on for each row stored"}, dqn.samples_per_insert,
        0.001, 10'000.0);
  v.key({"target_copy_updates"}, dqn.target_copy_updates, 1, 10'000'000);
  v.key({"averaging_updates",
         "weights that drive: a running average over about so many updates; 0: none"},
        dqn.averaging_updates, 0, 10'000'000);
  v.key({"learning_rate", "falls linearly over the phase"}, dqn.learning_rate, 1e-12, 1.0);
  v.key({"learning_rate_end"}, dqn.learning_rate_end, 0.0, 1.0);
  v.key({"annealing_steps",
         "of the phase, over which these and importance_exponent go to their ends; 0: all"},
        dqn.annealing_steps, 0, kStepsMax);
  v.key({"adam_epsilon"}, dqn.adam_epsilon, 1e-15, 1.0);
  v.key({"huber_delta"}, dqn.huber_delta, 1e-6, 1e6);
  v.key({"gradient_norm_max"}, dqn.gradient_norm_max, 1e-6, 1e9);
}

template <typename Visitor>
void describe_exploration(DqnSettings& dqn, Visitor& v) {
  v.key({"epsilon", "exploration, linear to epsilon_end"}, dqn.epsilon, 0.0, 1.0);
  v.key({"epsilon_end"}, dqn.epsilon_end, 0.0, 1.0);
  v.key({"epsilon_steps", "of the phase, all actors together"}, dqn.epsilon_steps, 1, kStepsMax);
  v.key({"epsilon_ladder", "actor i of N ends at epsilon_end^(1 + this * i / (N - 1))"},
        dqn.epsilon_ladder, 0.0, 100.0);
  v.key({"exploration_hold_max", "exploratory actions are held 1 to so many steps"},
        dqn.exploration_hold_max, 1, 1000);
}

template <typename Visitor>
void describe_replay(DqnSettings& dqn, Visitor& v) {
  v.key({"capacity", "rows in the replay"}, dqn.capacity, 1, 100'000'000);
  v.key({"minimum_size", "rows before training begins"}, dqn.minimum_size, 1, 100'000'000);
  v.key({"priority_exponent", "alpha; 0: uniform"}, dqn.priority_exponent, 0.0, 1.0);
  v.key({"importance_exponent", "beta, rises linearly over the phase"}, dqn.importance_exponent,
        0.0, 1.0);
  v.key({"importance_exponent_end"}, dqn.importance_exponent_end, 0.0, 1.0);
  v.key({"priority_offset", "added to |TD error|, so that nothing is never drawn"},
        dqn.priority_offset, 1e-9, 1e3);
}

template <typename Visitor>
void describe(DqnSettings& dqn, const char* table, const char* comment, Visitor& v) {
  v.table(table, comment, Heeds::kTraining);
  describe_training(dqn, v);
  describe_exploration(dqn, v);
  describe_replay(dqn, v);
}

template <typename Visitor>
void describe(ScheduleSettings& schedule, Visitor& v) {
  v.table("schedule", "Rounds, evaluation during training, checkpoints.", Heeds::kTraining);
  v.key({"steps_per_round", "of each actor: one chunk"}, schedule.steps_per_round, 1, 65'536);
  v.key({"selection_every_steps", "greedy evaluation; all actors together"},
        schedule.selection_every_steps, 1, kStepsMax);
  v.key({"selection_episodes", "on seeds of its own, the same each time"},
        schedule.selection_episodes, 1, 10'000);
  v.key({"selection_collision_cost", "best = reward - this * collisions, per 1000 steps"},
        schedule.selection_collision_cost, 0.0, 1e6);
  v.key({"mop_commands", "the BP that asks while the MoP is trained"}, schedule.mop_commands);
  v.key({"checkpoint_every_steps", "", Heeds::kRun}, schedule.checkpoint_every_steps, 1, kStepsMax);
  v.key({"checkpoints_kept", "", Heeds::kRun}, schedule.checkpoints_kept, 1, 1000);
}

template <typename Visitor>
void describe(EvaluationSettings& evaluation, Visitor& v) {
  v.table("evaluation", "What `corridor evaluate` does unless told otherwise.", Heeds::kEvaluation);
  v.key({"steps", "for each planner pair and seed"}, evaluation.steps, 1, kStepsMax);
  v.key({"seeds"}, evaluation.seeds, ListSize{1, 1000}, 0, kSeedMax);
}

template <typename Visitor>
void describe(RunSettings& run, Visitor& v) {
  v.table("run", "Where, with how many, and how long to wait.", Heeds::kRun);
  v.key({"seed", "of everything random", Heeds::kTraining}, run.seed, 0, kSeedMax);
  v.key({"actors", "processes that drive", Heeds::kTraining}, run.actors, 1, 1024);
  v.key({"device", "of the learner", Heeds::kTraining}, run.device);
  v.key({"transport"}, run.transport);
  v.key({"host", "of replay and learner, for tcp"}, run.host);
  v.key({"replay_port"}, run.replay_port, 1, 65'535);
  v.key({"learner_port"}, run.learner_port, 1, 65'535);
  v.key({"peer_timeout_s", "a peer silent for so long is lost"}, run.peer_timeout_s, 0.1, 86'400.0);
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
  for (const NamedNetwork& network : kNetworks)
    describe(config.dqn[static_cast<std::size_t>(network.id)], network.name, network.meaning, v);
  describe(config.schedule, v);
  describe(config.evaluation, v);
  describe(config.run, v);
}

}  // namespace corridor::config_keys
