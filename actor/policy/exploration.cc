// SPDX-License-Identifier: Apache-2.0
#include "actor/policy/exploration.h"

#include <algorithm>
#include <cmath>

#include "proto/base/random.h"

namespace corridor::policy {

double epsilon_of(const DqnSettings& settings, int actor, int actors, std::int64_t phase_steps) {
  const double rung = actors > 1 ? static_cast<double>(actor) / (actors - 1) : 0.0;
  const double end = std::pow(settings.epsilon_end, 1.0 + settings.epsilon_ladder * rung);
  const double done = settings.epsilon_steps > 0 ? static_cast<double>(phase_steps) /
                                                       static_cast<double>(settings.epsilon_steps)
                                                 : 1.0;
  return std::lerp(settings.epsilon, end, std::clamp(done, 0.0, 1.0));
}

Exploration::Exploration(const DqnSettings& settings, Phase phase, int actions,
                         std::uint64_t run_seed, int actor)
    : phase_(phase),
      actions_(actions),
      hold_max_(settings.exploration_hold_max),
      seed_(run_seed),
      actor_(static_cast<std::uint64_t>(actor)) {}

void Exploration::begin_episode(std::uint64_t episode) {
  episode_ = episode;
  held_until_ = 0;
}

std::optional<int> Exploration::action_for(std::uint64_t step, double epsilon) {
  if (step < held_until_) return held_action_;
  const auto draw = [&](std::uint64_t which) {
    return random_unit(seed_, Purpose::kExploration,
                       {static_cast<std::uint64_t>(phase_), actor_, episode_, step, which});
  };
  if (draw(0) >= epsilon) return std::nullopt;
  held_action_ = static_cast<int>(draw(1) * actions_);
  held_until_ = step + 1 + static_cast<std::uint64_t>(draw(2) * hold_max_);
  return held_action_;
}

}  // namespace corridor::policy
