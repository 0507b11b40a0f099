// A recorded episode, driven again, as a trace for pictures (proto/episode_trace.h).
#pragma once

#include <filesystem>

#include "actor/world/world.h"
#include "proto/episode_trace.h"
#include "proto/settings.h"

namespace corridor::actor {

// Throws Failure when the file is no episode, is of other settings, or does not drive again as
// recorded.
EpisodeTrace trace_episode(const RunConfig& config, const std::filesystem::path& file,
                           world::World& world);

}  // namespace corridor::actor
