// A driven episode, step by step, for pictures: what corridor-actor says of one, as JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proto/base/json.h"
#include "proto/settings/collision_kinds.h"

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
  double yaw_rad = 0.0;  // > 0 to the left
};

// Between two steps of the planners.
struct TracedScene {
  TracedVehicle ego;
  std::vector<TracedVehicle> others;
};

// What the planners saw, thought and chose, and what it earned.
struct TracedDecision {
  int corridor = 0;  // chosen; the road's count from the right, 0 first
  double set_point_mps = 0.0;
  int mop_action = 0;
  std::vector<double> bp_values;   // of each command; empty where no network decides
  std::vector<double> mop_values;  // of each MoP action; likewise
  int window_first = 0;            // the corridors that the MoP was shown, and which were open
  std::vector<bool> window_open;
  std::vector<double> front_gaps_m, back_gaps_m;  // of the road's corridors
  std::vector<double> path_s_m, path_d_m;         // the trajectory
  double bp_reward = 0.0, mop_reward = 0.0;       // of the step that followed
};

struct TracedStep {
  TracedVehicle ego;                  // id 0
  std::optional<int> command;         // that was asked for then, of EpisodeTrace::commands; none
                                      // when it was the last, or when no planner drove
  std::vector<TracedVehicle> others;  // ascending by id
  std::optional<TracedDecision> decision = {};  // as `command`
  std::vector<TracedScene> on_the_way = {};     // to the next step, at equal intervals; may be none
};

struct TracedCollision {
  CollisionKind kind = CollisionKind::kRearEnded;
  int other = 0;
};

struct EpisodeTrace {
  std::vector<std::string> commands;  // names of those that a planner can ask for
  double step_s = 0.0;
  int lanes = 0;
  double lane_width_m = 0.0;
  double speed_limit_mps = 0.0;
  double bp_reward = 0.0;  // of the whole episode
  int lane_changes = 0;
  std::optional<TracedCollision> collision;  // at the end of the last step
  std::vector<TracedStep> steps;             // the start, and what each step led to

  // CHECKs that there is such a command.
  const std::string& command_name(int command) const;
};

Json to_json(const EpisodeTrace& trace);
// Throws Failure naming `name` when a field is missing or wrong, or there is no step.
EpisodeTrace parse_episode_trace(const Json& json, const std::string& name);

}  // namespace corridor
