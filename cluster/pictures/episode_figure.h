// SPDX-License-Identifier: Apache-2.0
// Driven episodes of one arm as a figure. Pure.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "cluster/pictures/canvas.h"
#include "proto/run/episode_trace.h"

namespace corridor::cluster {

// Of a failed episode, the last of which is the collision; fewer where it has fewer.
inline constexpr std::size_t kShownInstants = 6;

struct DrivenEpisode {
  std::string name;  // of its file: "hierarchical_1002_3"
  EpisodeTrace trace;
};

// At least one of the two.
struct EpisodeFigure {
  std::string planner;
  std::optional<DrivenEpisode> typical;
  std::optional<DrivenEpisode> failed;  // ends with a collision
};

// Of the typical episode lateral position and speed over time; of the failed one the road from
// above at its last instants.
Canvas picture_of(const EpisodeFigure& figure);

// What the picture shows, for people.
std::string caption_of(const EpisodeFigure& figure);

}  // namespace corridor::cluster
