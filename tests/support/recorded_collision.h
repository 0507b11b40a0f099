// Drives straight on, ever faster, until the ego hits somebody, and records it as an evaluation
// does.
#pragma once

#include <filesystem>
#include <string>

#include "actor/episode.h"
#include "proto/base/failure.h"
#include "proto/base/json.h"
#include "proto/run/run_directory.h"

namespace corridor::testing_support {

inline Json record_collision(const RunConfig& config, world::World& world) {
  actor::Episode episode(config, world);
  const int fastest = static_cast<int>(config.planner.speed_changes_mps.size()) - 1;
  for (std::uint64_t seed = 1; seed < 100; ++seed) {
    episode.begin({.seed = seed});
    while (!episode.step(driving::Command::kKeep, driving::index_of({0, fastest})).episode_ended) {
    }
    if (!episode.summary().collision || episode.summary().steps < 5) continue;
    return {{"planner", "keep+rules"},
            {"episode_seed", seed},
            {"driven_by_world", false},
            {"actions", episode.actions()},
            {"trajectory_hash", fmt::format("{:016x}", episode.trajectory_hash())},
            {"summary", {{"steps", episode.summary().steps}}}};
  }
  throw Failure("no seed leads to a collision");
}

}  // namespace corridor::testing_support
