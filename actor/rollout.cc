// SPDX-License-Identifier: Apache-2.0
#include "actor/rollout.h"

#include "actor/driving/observation.h"
#include "actor/driving/reward.h"
#include "actor/planners.h"
#include "actor/world/traffic.h"
#include "proto/base/failure.h"

namespace corridor::actor {

using driving::Command;

PhaseRollout::PhaseRollout(const RunConfig& config, int actor, world::World& world,
                           TimeAccount& time, std::uint64_t next_round, const OpenEpisode& open)
    : config_(config),
      driving_(driving_settings(config)),
      schedule_(config),
      phase_(schedule_.phase_of(next_round)),
      trains_bp_(phase_ == Phase::kBp),
      random_commands_(!trains_bp_ && config.schedule.mop_commands == MopCommands::kRandom),
      actor_(actor),
      next_round_(next_round),
      episode_(config, world),
      random_bp_(driving_),
      exploration_(config.phase(phase_), phase_, config.shape(phase_).actions, config.run.seed,
                   actor),
      transitions_({config.shape(phase_).observations}, config.phase(phase_)),
      episode_index_(open.episode),
      observation_(static_cast<std::size_t>(config.shape(phase_).observations)),
      other_observation_(static_cast<std::size_t>(
          config.shape(trains_bp_ ? NetworkId::kMop : NetworkId::kBp).observations)),
      time_(time) {
  const auto rounds_before = static_cast<std::int64_t>(next_round - schedule_.first_round(phase_));
  const auto recorded = static_cast<std::int64_t>(open.actions.size());
  std::int64_t own_step = rounds_before * config.schedule.steps_per_round - recorded;
  if (own_step < 0) {
    throw Failure(
        "the open episode of actor {} has {} steps, more than its phase had so far: the "
        "checkpoint is of another configuration",
        actor, recorded);
  }
  for (const std::uint8_t action : open.actions) step(own_step++, action);
  if (episode_index_ != open.episode) {
    throw Failure(
        "the open episode of actor {} ended when it was driven again: the checkpoint is "
        "of another configuration",
        actor_);
  }
  // Its complete rows were sent, and its steps counted, when they were driven first.
  transitions_.take_rows();
  totals_ = {};
}

Insert PhaseRollout::drive_round(const Weights& weights) {
  use(weights);
  const int steps = config_.schedule.steps_per_round;
  const auto rounds_before = static_cast<std::int64_t>(next_round_ - schedule_.first_round(phase_));
  for (int i = 0; i < steps; ++i) step(rounds_before * steps + i, std::nullopt);

  Insert chunk;
  chunk.round = next_round_++;
  chunk.observations = static_cast<std::uint32_t>(observation_.size());
  chunk.rows = transitions_.take_rows();
  time_.charge(TimePart::kPlan);
  chunk.priorities = network(phase_).td_errors(chunk.rows);
  time_.charge(TimePart::kInfer);
  chunk.open.episode = episode_index_;
  if (episode_open_) chunk.open.actions = episode_.actions();
  return chunk;
}

void PhaseRollout::use(const Weights& weights) {
  networks_.clear();
  for (const NamedNetwork& network : kNetworks) {
    networks_.emplace_back(config_.phase(network.id), config_.shape(network.id),
                           weights.networks[network.id]);
  }
}

SelectionOutcome PhaseRollout::select(const Weights& weights) {
  use(weights);
  if (episode_open_) cut_off_episode();
  QMotionPlanner mop(config_, weights.networks);
  QBehaviourPlanner learned_bp(config_, weights.networks);
  driving::BehaviourPlanner& bp =
      random_commands_ ? static_cast<driving::BehaviourPlanner&>(random_bp_) : learned_bp;
  SelectionOutcome outcome;
  outcome.round = next_round_;
  for (int i = actor_; i < config_.schedule.selection_episodes; i += config_.run.actors) {
    const auto seed =
        selection_episode_seed(config_.run.seed, phase_, static_cast<std::uint64_t>(i));
    drive(episode_, {.seed = seed}, bp, mop, config_.simulation.episode_steps);
    const EpisodeSummary& summary = episode_.summary();
    ++outcome.episodes;
    outcome.steps += static_cast<std::uint64_t>(summary.steps);
    outcome.reward += trains_bp_ ? summary.bp_reward : summary.mop_reward;
    outcome.collisions += summary.collision.has_value();
  }
  episode_.end();
  return outcome;
}

void PhaseRollout::begin_episode() {
  const auto seed = training_episode_seed(config_.run.seed, phase_, actor_, episode_index_);
  episode_.begin({.seed = seed,
                  .traffic = world::draw_traffic(config_.traffic, config_.training_traffic, seed)});
  random_bp_.begin_episode(seed);
  exploration_.begin_episode(episode_index_);
  episode_open_ = true;
}

void PhaseRollout::step(std::int64_t own_step, std::optional<std::uint8_t> recorded) {
  if (!episode_open_) begin_episode();
  totals_.epsilon = policy::epsilon_of(config_.phase(phase_), actor_, config_.run.actors,
                                       own_step * config_.run.actors);
  const auto random_action = exploration_.action_for(
      static_cast<std::uint64_t>(episode_.situation().step), totals_.epsilon);
  const driving::StepAction action = decide(random_action, recorded);
  const StepOutcome outcome = episode_.step(action.command, action.mop_action);

  const bool collided = episode_.summary().collision.has_value();
  double reward = outcome.mop_reward;
  double shaping = 0.0;
  int chosen = action.mop_action;
  bool terminal = collided || outcome.entered_closed;
  if (trains_bp_) {
    reward = outcome.bp_reward;
    shaping = driving::bp_shaping(collided, outcome.lane_changed, config_.bp_reward);
    chosen = static_cast<int>(action.command);
    terminal = collided;
  }
  transitions_.push(observation_, chosen, {reward + shaping, collided ? 1.0 : 0.0, terminal});

  ++totals_.steps;
  totals_.reward += reward;
  totals_.collisions += collided;
  if (!outcome.episode_ended) return;
  ++totals_.episodes;
  totals_.episodic_return +=
      trains_bp_ ? episode_.summary().bp_reward : episode_.summary().mop_reward;
  if (terminal) {
    leave_episode();
  } else {
    cut_off_episode();
  }
}

Command PhaseRollout::command(const std::optional<std::uint8_t>& recorded) {
  const driving::Situation& situation = episode_.situation();
  if (!random_commands_) {
    if (recorded) return driving::unpack(*recorded).command;
    // Without weights yet: a recorded episode that has ended, which the constructor refuses.
    if (networks_.empty()) return Command::kKeep;
    driving::observe_bp(situation.scene, situation.previous, driving_, other_observation_);
    return static_cast<Command>(greedy(NetworkId::kBp, other_observation_));
  }
  // Asked in either case: what the random BP does next depends on its having been asked.
  const Command asked = random_bp_.decide(situation);
  if (recorded && asked != driving::unpack(*recorded).command) {
    throw Failure(
        "the open episode of actor {} cannot be driven again: its step {} was driven under another "
        "command; the checkpoint is of another configuration",
        actor_, situation.step);
  }
  return asked;
}

driving::StepAction PhaseRollout::decide(std::optional<int> random_action,
                                         const std::optional<std::uint8_t>& recorded) {
  const driving::Situation& situation = episode_.situation();
  driving::StepAction action;
  if (recorded) action = driving::unpack(*recorded);
  if (!trains_bp_) {
    action.command = command(recorded);
    observe(action.command);
    if (!recorded) {
      action.mop_action = random_action ? *random_action : greedy(phase_, observation_);
    }
    return action;
  }
  observe(action.command);
  if (recorded) return action;
  action.command =
      static_cast<Command>(random_action ? *random_action : greedy(phase_, observation_));
  const driving::Window window = episode_.window(action.command);
  driving::observe_mop(situation.scene, situation.gaps, window, driving_, other_observation_);
  action.mop_action = greedy(window.network, other_observation_);
  return action;
}

int PhaseRollout::greedy(NetworkId id, const std::vector<float>& observation) {
  time_.charge(TimePart::kPlan);
  const int action = network(id).greedy(observation);
  time_.charge(TimePart::kInfer);
  return action;
}

void PhaseRollout::observe(Command command) {
  const driving::Situation& situation = episode_.situation();
  if (trains_bp_) {
    driving::observe_bp(situation.scene, situation.previous, driving_, observation_);
  } else {
    driving::observe_mop(situation.scene, situation.gaps, episode_.window(command), driving_,
                         observation_);
  }
}

void PhaseRollout::cut_off_episode() {
  observe(trains_bp_ ? Command::kKeep : command(std::nullopt));
  transitions_.cut_off(observation_);
  leave_episode();
}

void PhaseRollout::leave_episode() {
  episode_open_ = false;
  ++episode_index_;
}

}  // namespace corridor::actor
