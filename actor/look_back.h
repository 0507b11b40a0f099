// Looks back on every collision of an evaluation.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "actor/avoidance.h"
#include "actor/world/world.h"
#include "proto/run/run_directory.h"
#include "proto/settings/settings.h"

namespace corridor::actor {

struct HindsightTask {
  std::string planner;
  std::uint64_t seed = 0;  // of the evaluation
  HindsightLimits limits;
};

// Reads what an evaluation (actor/evaluation.h) wrote about `planner` and `seed`, and writes
//   evaluation/hindsight/<planner>_<seed>.json
//     {"planner", "seed", "steps", "actions", "attempts_max",   of the evaluation; the limits
//      "collisions": one object each:
//        {"episode", "collision_kind", "step", "actions_in_sight",
//         "by_reacting": verdict,
//         "by_last_actions": [verdict ...] by the last 1, 2 ... `actions`,
//         "attempts": [...] one a search,
//         "recorded": [MoP actions] the last ones, at most `actions`; empty where the world drove,
//         "escape": [MoP actions] with those of the margin; empty when none was found}}
// `progress` hears of the collisions done, of how many, after each; when it returns false the
// report ends without writing its file. Equal tasks write equal files. Throws Failure as look_back
// does, and when there is no such evaluation.
void report_hindsight(const RunConfig& config, const HindsightTask& task,
                      const RunDirectory& directory, world::World& world,
                      const std::function<bool(std::size_t done, std::size_t total)>& progress);

}  // namespace corridor::actor
