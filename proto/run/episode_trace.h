// SPDX-License-Identifier: Apache-2.0
// A driven episode, step by step, for pictures: what corridor-actor says of one, as JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proto/run/json_record.h"
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

  // The list of these numbers.
  friend void to_json(Json& json, const TracedVehicle& vehicle);
  friend void from_json(const Json& json, TracedVehicle& vehicle);
};

// Between two steps of the planners.
struct TracedScene {
  TracedVehicle ego;
  std::vector<TracedVehicle> others;

  template <typename Self, typename Field>
  static void fields(Self& self, Field field) {
    field("ego", self.ego);
    field("others", self.others);
  }
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

  template <typename Self, typename Field>
  static void fields(Self& self, Field field) {
    field("corridor", self.corridor);
    field("set_point_mps", self.set_point_mps);
    field("mop_action", self.mop_action);
    field("bp_values", self.bp_values);
    field("mop_values", self.mop_values);
    field("window_first", self.window_first);
    field("window_open", self.window_open);
    field("front_gaps_m", self.front_gaps_m);
    field("back_gaps_m", self.back_gaps_m);
    field("path_s_m", self.path_s_m);
    field("path_d_m", self.path_d_m);
    field("bp_reward", self.bp_reward);
    field("mop_reward", self.mop_reward);
  }
};

struct TracedStep {
  TracedVehicle ego;                  // id 0
  std::optional<int> command;         // that was asked for then, of EpisodeTrace::commands; none
                                      // when it was the last, or when no planner drove
  std::vector<TracedVehicle> others;  // ascending by id
  std::optional<TracedDecision> decision = {};  // as `command`
  std::vector<TracedScene> on_the_way = {};     // to the next step, at equal intervals; may be none

  template <typename Self, typename Field>
  static void fields(Self& self, Field field) {
    field("ego", self.ego);
    field("command", self.command, kLeftOut);
    field("others", self.others);
    field("decision", self.decision, kLeftOut);
    field("on_the_way", self.on_the_way);
  }
};

struct TracedCollision {
  CollisionKind kind = CollisionKind::kRearEnded;
  int other = 0;

  template <typename Self, typename Field>
  static void fields(Self& self, Field field) {
    field("kind", self.kind);
    field("other", self.other);
  }
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

  template <typename Self, typename Field>
  static void fields(Self& self, Field field) {
    field("commands", self.commands);
    field("step_s", self.step_s);
    field("lanes", self.lanes);
    field("lane_width_m", self.lane_width_m);
    field("speed_limit_mps", self.speed_limit_mps);
    field("bp_reward", self.bp_reward);
    field("lane_changes", self.lane_changes);
    field("collision", self.collision, kLeftOut);
    field("steps", self.steps);
  }
  void check() const;
};

}  // namespace corridor
