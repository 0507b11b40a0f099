// Has corridor-actor drive an episode and say what happened at every step.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "proto/run/episode_trace.h"
#include "proto/run/run_directory.h"

namespace corridor::cluster {

// `arguments` follow the run directory, --trace FILE or --drive PAIR first. Throws Failure when
// that takes longer or fails.
EpisodeTrace traced_by_actor(const RunDirectory& directory,
                             const std::vector<std::string>& arguments,
                             std::chrono::minutes patience);

}  // namespace corridor::cluster
