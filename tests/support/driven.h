// SPDX-License-Identifier: Apache-2.0
// A driven episode, and what is drawn of one.
#pragma once

#include <string>
#include <vector>

#include "cluster/pictures/canvas.h"
#include "proto/run/episode_trace.h"

namespace corridor::testing_support {

// At 10 m/s in the middle of three lanes, two substeps a second; vehicle 8 is in the right lane 20
// m ahead from the second 2 on, 9 stands in the left lane at 60 m always. It ends with a collision
// with 9.
inline EpisodeTrace driven_episode(std::size_t steps) {
  EpisodeTrace trace;
  trace.commands = {"keep", "left", "right"};
  trace.step_s = 1.0;
  trace.commands = {"keep", "left", "right"};
  trace.lanes = 3;
  trace.lane_width_m = 3.2;
  trace.speed_limit_mps = 13.89;
  trace.bp_reward = 500.0;
  trace.lane_changes = 7;
  trace.collision = {CollisionKind::kRearEnding, 9};
  for (std::size_t i = 0; i < steps; ++i) {
    const double s_m = 10.0 * static_cast<double>(i);
    TracedStep step;
    step.ego = {0, s_m, 4.8, 10.0, 5.0, 1.8, 0.0};
    step.command = 1;
    if (i >= 2) step.others.push_back({8, s_m + 20.0, 1.6, 12.5, 5.0, 1.8, 0.0});
    step.others.push_back({9, 60.0, 8.0, 0.0, 5.0, 1.8, 0.0});
    TracedDecision decision;
    decision.corridor = 8;
    decision.mop_action = 4;
    decision.bp_values = {1.0, 2.0, 0.5};
    decision.mop_values = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
    decision.window_first = 5;
    decision.window_open = {false, true, true, true, false};
    decision.front_gaps_m.assign(15, 40.0);
    decision.back_gaps_m.assign(15, 20.0);
    decision.path_s_m = {s_m, s_m + 10.0, s_m + 20.0};
    decision.path_d_m = {4.8, 5.2, 5.4};
    step.decision = decision;
    step.on_the_way.push_back({{0, s_m + 4.0, 5.0, 11.0, 5.0, 1.8, 0.1}, step.others});
    trace.steps.push_back(step);
  }
  return trace;
}

// All shapes of one kind, those of insets too, where they are within these.
template <typename What>
std::vector<What> drawn(const std::vector<cluster::Shape>& shapes) {
  std::vector<What> found;
  for (const cluster::Shape& shape : shapes) {
    if (const auto* what = std::get_if<What>(&shape.what)) found.push_back(*what);
    if (const auto* inset = std::get_if<cluster::Inset>(&shape.what)) {
      for (const What& within : drawn<What>(inset->shapes)) found.push_back(within);
    }
  }
  return found;
}

inline std::vector<std::string> texts(const cluster::Canvas& canvas) {
  std::vector<std::string> found;
  for (const cluster::Text& text : drawn<cluster::Text>(canvas.shapes)) found.push_back(text.text);
  return found;
}

inline std::vector<cluster::Area> areas(const cluster::Canvas& canvas, cluster::Colour colour) {
  std::vector<cluster::Area> found = drawn<cluster::Area>(canvas.shapes);
  std::erase_if(found, [&](const cluster::Area& area) { return area.colour != colour; });
  return found;
}

}  // namespace corridor::testing_support
