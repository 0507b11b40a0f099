// SPDX-License-Identifier: Apache-2.0
// An episode as it is driven, as a trace for pictures (proto/run/episode_trace.h).
#pragma once

#include <cstdint>
#include <filesystem>

#include "actor/world/world.h"
#include "proto/run/episode_trace.h"
#include "proto/run/networks.h"
#include "proto/settings/planner_pairs.h"
#include "proto/settings/settings.h"

namespace corridor::actor {

// A recorded one, driven again; with `networks` of its planners their values are in it. Throws
// Failure when the file is no episode, is of other settings, or does not drive again as recorded.
EpisodeTrace trace_episode(const RunConfig& config, const Networks* networks,
                           const std::filesystem::path& file, world::World& world);

// A new one from that episode seed on, at most `steps` of it.
EpisodeTrace trace_drive(const RunConfig& config, const Networks& networks, const PlannerPair& pair,
                         std::uint64_t episode_seed, std::int64_t steps, world::World& world);

}  // namespace corridor::actor
