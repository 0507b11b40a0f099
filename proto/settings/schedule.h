// SPDX-License-Identifier: Apache-2.0
// When everything happens: training is cut into rounds (docs/architecture.md, "Lockstep"). Every
// process derives the same schedule from the run's configuration. Pure.
//
// Round r: each actor drives steps_per_round steps with weights version `weights_version(r)`;
// block r: the learner trains on rounds up to r and publishes version r + 1. Round r and block
// r - 1 go on at the same time. A phase's rounds are consecutive; phases follow one another in the
// order of kNetworks.
#pragma once

#include <array>
#include <cstdint>

#include "proto/settings/settings.h"

namespace corridor {

class Schedule {
 public:
  explicit Schedule(const RunConfig& config);

  std::uint64_t rounds() const { return starts_.back(); }  // of all phases
  std::uint64_t first_round(Phase phase) const { return starts_[static_cast<std::size_t>(phase)]; }
  // The budget divided, rounded up.
  std::uint64_t rounds_of(Phase phase) const {
    return starts_[static_cast<std::size_t>(phase) + 1] - first_round(phase);
  }
  Phase phase_of(std::uint64_t round) const;   // round < rounds()
  bool ends_phase(std::uint64_t round) const;  // whether it is its phase's last

  // Environment steps of all actors in one round, and in the phase up to the end of `round`.
  std::int64_t steps_per_round() const { return steps_per_round_; }
  std::int64_t phase_steps_after(std::uint64_t round) const;
  // Share of the phase's annealing_steps, its budget unless given, that lies before `round`, in
  // [0, 1].
  double annealed(std::uint64_t round) const;

  // The weights that round r is driven with: max(first round of its phase, r - 1). A phase's first
  // version is published before any of the phase's blocks is trained.
  std::uint64_t weights_version(std::uint64_t round) const;

  // Whether the actors evaluate weights_version(round) greedily before they drive this round: every
  // selection_every_steps, and in a phase's last round.
  bool selects_in(std::uint64_t round) const;
  // Whether the learner takes a checkpoint after block `round`: every checkpoint_every_steps, and
  // after the last block.
  bool checkpoints_after(std::uint64_t round) const;

 private:
  std::int64_t steps_per_round_;
  std::array<std::uint64_t, kNetworks.size() + 1> starts_{};  // of the phases; then rounds()
  std::array<std::uint64_t, kNetworks.size()> annealing_rounds_{};
  std::uint64_t selection_every_;   // rounds
  std::uint64_t checkpoint_every_;  // rounds
};

}  // namespace corridor
