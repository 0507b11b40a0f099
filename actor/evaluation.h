// SPDX-License-Identifier: Apache-2.0
// Greedy episodes on held-out traffic -> their records in the run directory.
#pragma once

#include <cstdint>
#include <functional>

#include "actor/episode.h"
#include "actor/planners.h"
#include "actor/world/world.h"
#include "proto/run/actor_task.h"
#include "proto/run/evaluation_record.h"
#include "proto/run/run_directory.h"
#include "proto/settings/settings.h"

namespace corridor::actor {

// Of an evaluation's episode `index`.
EpisodeRecord record_of(const EpisodeSummary& summary, std::uint64_t index);

// Drives episodes 0, 1, 2 ... of the task's seed and writes their records (recorded_episode.h) and,
// at the end, the evaluation's (evaluation_record.h). `progress` hears of the steps done after each
// episode; when it returns false the evaluation ends without its own record. Equal tasks write
// equal files. Throws Failure when there is no such planner pair or the disk is full.
void evaluate(const RunConfig& config, const Networks& networks, const EvaluateTask& task,
              const RunDirectory& directory, world::World& world,
              const std::function<bool(std::int64_t steps)>& progress);

}  // namespace corridor::actor
