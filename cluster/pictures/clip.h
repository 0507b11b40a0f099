// SPDX-License-Identifier: Apache-2.0
// A stretch of a driven episode, and where everything is at any time in it. Pure.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "proto/run/episode_trace.h"

namespace corridor::cluster {

// Of the MoP, by name: its action is a speed change and, within that, one of these.
inline constexpr std::array kCorridorChanges = {"right", "straight", "left"};

struct Clip {
  std::string title;                      // "hierarchical, seed 1002, episode 3, rigid"
  EpisodeTrace trace;                     // of this stretch only
  double start_s = 0.0;                   // of the trace, after the episode's start
  std::vector<double> speed_changes_mps;  // of the MoP's actions

  double duration_s() const;
  // The step that is under way then.
  const TracedStep& step_at(double time_s) const;
  // Between two simulated instants positions are interpolated.
  TracedScene scene_at(double time_s) const;
};

// From `from_s` to `to_s` after the trace's start, in whole steps, as far as it goes.
Clip clip_of(const EpisodeTrace& trace, const std::string& title, double from_s, double to_s);

}  // namespace corridor::cluster
