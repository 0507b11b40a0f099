// Looks back on every collision of an evaluation.
#pragma once

#include <cstdint>
#include <functional>

#include "actor/world/world.h"
#include "proto/run/actor_task.h"
#include "proto/run/run_directory.h"
#include "proto/settings/settings.h"

namespace corridor::actor {

// Reads what an evaluation (actor/evaluation.h) wrote about the task's planner and seed, and writes
// a record of its collisions (proto/run/hindsight_record.h). `progress` hears of the collisions
// done, of how many, after each; when it returns false nothing is written. Equal tasks write equal
// files. Throws Failure as look_back does, and when there is no such evaluation.
void report_hindsight(const RunConfig& config, const LookBackTask& task,
                      const RunDirectory& directory, world::World& world,
                      const std::function<bool(std::int64_t done, std::int64_t total)>& progress);

}  // namespace corridor::actor
