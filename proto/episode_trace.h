// A driven episode, step by step, for pictures: what corridor-actor says of one, as JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proto/json_numbers.h"

namespace corridor {

// Positions are as in actor/driving/scene.h: of the middle of the front bumper, along the road and
// across it from its right edge.
struct TracedVehicle {
  int id = 0;
  double s_m = 0.0;
  double d_m = 0.0;
  double speed_mps = 0.0;
  double length_m = 0.0;
  double width_m = 0.0;
};

struct TracedStep {
  TracedVehicle ego;                  // id 0
  std::optional<int> command;         // that was asked for then; none when it was the last, or when
                                      // no planner drove
  std::vector<TracedVehicle> others;  // ascending by id
};

struct TracedCollision {
  std::string kind;  // "rear_ended", ...
  int other = 0;
};

struct EpisodeTrace {
  double step_s = 0.0;
  int lanes = 0;
  double lane_width_m = 0.0;
  double speed_limit_mps = 0.0;
  double bp_reward = 0.0;  // of the whole episode
  int lane_changes = 0;
  std::optional<TracedCollision> collision;  // at the end of the last step
  std::vector<TracedStep> steps;             // the start, and what each step led to
};

nlohmann::json to_json(const EpisodeTrace& trace);
// Throws Failure naming `name` when a field is missing or wrong, or there is no step.
EpisodeTrace parse_episode_trace(const nlohmann::json& json, const std::string& name);

}  // namespace corridor
