// SPDX-License-Identifier: Apache-2.0
// Has corridor-actor drive an episode and say what happened at every step.
#pragma once

#include <chrono>

#include "proto/run/actor_task.h"
#include "proto/run/episode_trace.h"
#include "proto/run/run_directory.h"

namespace corridor::cluster {

// `task`: a TraceTask or a DriveTask. Throws Failure when that takes longer or fails.
EpisodeTrace traced_by_actor(const RunDirectory& directory, const ActorTask& task,
                             std::chrono::minutes patience);

}  // namespace corridor::cluster
