// The traffic of one training episode, drawn from a distribution, so that planners learn to drive
// in more than one kind (domain randomisation, Tobin et al. 2017). Pure.
#pragma once

#include <cstdint>

#include "proto/settings/settings.h"

namespace corridor::world {

// `traffic`, with the episode's own values for what `distribution` says. What SUMO's vehicle types
// hold (sizes, keep_right) is the run's and the same for all.
TrafficSettings draw_traffic(const TrafficSettings& traffic,
                             const TrafficDistribution& distribution, std::uint64_t episode_seed);

}  // namespace corridor::world
