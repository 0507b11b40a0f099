// SPDX-License-Identifier: Apache-2.0
#include "proto/settings/schedule.h"

#include <algorithm>

#include "proto/base/failure.h"

namespace corridor {
namespace {

std::uint64_t rounds_for(std::int64_t steps, std::int64_t steps_per_round) {
  return static_cast<std::uint64_t>(
      std::max<std::int64_t>(1, (steps + steps_per_round - 1) / steps_per_round));
}

}  // namespace

Schedule::Schedule(const RunConfig& config)
    : steps_per_round_(static_cast<std::int64_t>(config.schedule.steps_per_round) *
                       config.run.actors),
      selection_every_(rounds_for(config.schedule.selection_every_steps, steps_per_round_)),
      checkpoint_every_(rounds_for(config.schedule.checkpoint_every_steps, steps_per_round_)) {
  for (std::size_t i = 0; i < config.dqn.size(); ++i) {
    const DqnSettings& dqn = config.dqn[i];
    starts_[i + 1] = starts_[i] + rounds_for(dqn.steps, steps_per_round_);
    annealing_rounds_[i] =
        rounds_for(dqn.annealing_steps > 0 ? dqn.annealing_steps : dqn.steps, steps_per_round_);
  }
}

Phase Schedule::phase_of(std::uint64_t round) const {
  CORRIDOR_CHECK(round < rounds(), "round {} of {}", round, rounds());
  // No phase is without rounds.
  return static_cast<Phase>(std::ranges::upper_bound(starts_, round) - starts_.begin() - 1);
}

bool Schedule::ends_phase(std::uint64_t round) const {
  return std::ranges::binary_search(starts_, round + 1);
}

std::int64_t Schedule::phase_steps_after(std::uint64_t round) const {
  return static_cast<std::int64_t>(round - first_round(phase_of(round)) + 1) * steps_per_round_;
}

double Schedule::annealed(std::uint64_t round) const {
  const Phase phase = phase_of(round);
  const double share = static_cast<double>(round - first_round(phase)) /
                       static_cast<double>(annealing_rounds_[static_cast<std::size_t>(phase)]);
  return std::min(share, 1.0);
}

std::uint64_t Schedule::weights_version(std::uint64_t round) const {
  const std::uint64_t first = first_round(phase_of(round));
  return round > first ? round - 1 : first;
}

bool Schedule::selects_in(std::uint64_t round) const {
  const std::uint64_t done = round - first_round(phase_of(round)) + 1;
  return done % selection_every_ == 0 || ends_phase(round);
}

bool Schedule::checkpoints_after(std::uint64_t round) const {
  return (round + 1) % checkpoint_every_ == 0 || round + 1 == rounds();
}

}  // namespace corridor
