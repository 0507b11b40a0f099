// SPDX-License-Identifier: Apache-2.0
// Epsilon-greedy exploration, with an epsilon of its own for each actor (Horgan et al. 2018) and
// random actions that may be held for a few steps.
#pragma once

#include <cstdint>
#include <optional>

#include "proto/settings/settings.h"

namespace corridor::policy {

// Actor `actor` of `actors`, when `phase_steps` steps of the phase have been driven by all actors.
double epsilon_of(const DqnSettings& settings, int actor, int actors, std::int64_t phase_steps);

// Which steps of an episode explore, and with what: a function of (seed, phase, actor, episode,
// step) and epsilon alone, so that an episode that is driven again explores at the same steps.
class Exploration {
 public:
  Exploration(const DqnSettings& settings, Phase phase, int actions, std::uint64_t run_seed,
              int actor);

  void begin_episode(std::uint64_t episode);

  // The random action of this step, or nothing where the greedy one is to be taken. To be called
  // once a step, in order: where no random action is being held, one begins with probability
  // `epsilon` and is held for 1 to exploration_hold_max steps.
  std::optional<int> action_for(std::uint64_t step, double epsilon);

 private:
  Phase phase_;
  int actions_;
  int hold_max_;
  std::uint64_t seed_;
  std::uint64_t actor_;
  std::uint64_t episode_ = 0;
  int held_action_ = 0;
  std::uint64_t held_until_ = 0;  // first step that is free again
};

}  // namespace corridor::policy
