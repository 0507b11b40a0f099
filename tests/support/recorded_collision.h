// SPDX-License-Identifier: Apache-2.0
// Drives straight on, ever faster, until the ego hits somebody, and records it as an evaluation
// does: as rules_5_1.
#pragma once

#include "actor/episode.h"
#include "actor/evaluation.h"
#include "proto/base/failure.h"
#include "proto/run/recorded_episode.h"

namespace corridor::testing_support {

inline RecordedEpisode record_collision(const RunConfig& config, world::World& world) {
  actor::Episode episode(config, world);
  const int fastest = static_cast<int>(config.planner.speed_changes_mps.size()) - 1;
  for (std::uint64_t seed = 1; seed < 100; ++seed) {
    episode.begin({.seed = seed});
    while (!episode.step(driving::Command::kKeep, driving::index_of({0, fastest})).episode_ended) {
    }
    if (!episode.summary().collision || episode.summary().steps < 5) continue;
    return {"rules",
            5,
            1,
            seed,
            false,
            episode.actions(),
            episode.trajectory_hash(),
            actor::record_of(episode.summary(), 1)};
  }
  throw Failure("no seed leads to a collision");
}

}  // namespace corridor::testing_support
