// SPDX-License-Identifier: Apache-2.0
// An actor's side of training: observe, decide, step, record.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "actor/driving/random_bp.h"
#include "actor/episode.h"
#include "actor/n_step.h"
#include "actor/policy/action_values.h"
#include "actor/policy/exploration.h"
#include "proto/settings/schedule.h"
#include "proto/system/time_account.h"
#include "proto/wire/messages.h"

namespace corridor::actor {

// Totals since they were last taken.
struct RolloutTotals {
  std::int64_t steps = 0;
  std::int64_t episodes = 0;  // that ended
  std::int64_t collisions = 0;
  double reward = 0.0;           // of the planner in training, unscaled, without shaping
  double episodic_return = 0.0;  // summed over the ended episodes
  double epsilon = 0.0;          // the latest
};

// One phase of one actor. What it does is a function of (config, actor, round, the open episode it
// starts from, the weights). One thread owns it; `config`, `world` and `time`
// outlive it.
class PhaseRollout {
 public:
  // Stands before `next_round` with the open episode of the rounds before: drives it again up to
  // where it was. Throws Failure when the recorded actions cannot be this run's.
  PhaseRollout(const RunConfig& config, int actor, world::World& world, TimeAccount& time,
               std::uint64_t next_round, const OpenEpisode& open);

  // Drives the next round with these weights, exploring.
  Insert drive_round(const Weights& weights);

  // Drives this actor's share of the selection episodes greedily, before the next round. It cuts
  // off the open training episode: the next round begins with a new one.
  SelectionOutcome select(const Weights& weights);

  Phase phase() const { return phase_; }
  std::uint64_t next_round() const { return next_round_; }
  RolloutTotals take_totals() { return std::exchange(totals_, {}); }

 private:
  void begin_episode();
  // One step of training; with what was recorded for it instead of a greedy choice when it is
  // driven again. `own_step` counts this actor's steps in the phase.
  void step(std::int64_t own_step, std::optional<std::uint8_t> recorded);
  // What the BP asks for while a network that drives skills is trained.
  driving::Command command(const std::optional<std::uint8_t>& recorded);
  driving::StepAction decide(std::optional<int> random_action,
                             const std::optional<std::uint8_t>& recorded);
  policy::ActionValues& network(NetworkId id) { return networks_[static_cast<std::size_t>(id)]; }
  int greedy(NetworkId id, const std::vector<float>& observation);
  // What the network in training sees now, given the command where it drives skills.
  void observe(driving::Command command);
  void use(const Weights& weights);
  void cut_off_episode();
  void leave_episode();

  const RunConfig& config_;
  DrivingSettings driving_;
  Schedule schedule_;
  Phase phase_;
  bool trains_bp_;        // otherwise a network that drives skills
  bool random_commands_;  // then: the random BP asks for them
  int actor_;
  std::uint64_t next_round_;

  Episode episode_;
  driving::RandomBp random_bp_;
  policy::Exploration exploration_;
  NStepBuilder transitions_;
  std::uint64_t episode_index_;
  bool episode_open_ = false;

  std::vector<policy::ActionValues> networks_;  // by id
  std::vector<float> observation_;              // of the planner in training
  std::vector<float> other_observation_;        // of the planner that is not
  RolloutTotals totals_;
  TimeAccount& time_;
};

}  // namespace corridor::actor
