// SPDX-License-Identifier: Apache-2.0
// What actor/driving needs to know, and no more; see proto/settings/settings.h.
#pragma once

#include <vector>

namespace corridor {

struct RoadSettings {
  int lanes = 3;
  double lane_width_m = 3.2;
  double length_m = 20000.0;
  double speed_limit_mps = 13.89;
};

struct EgoSettings {
  double length_m = 5.0;
  double width_m = 1.8;
  double acceleration_max_mps2 = 2.5;
  double deceleration_max_mps2 = 6.0;
};

struct PlannerSettings {
  int corridors_per_lane = 5;
  std::vector<double> speed_changes_mps = {-4.0, -2.0, -1.0, 0.0, 1.0, 2.0};
  double corridor_change_s = 1.0;
  double gap_range_m = 100.0;
  double side_clearance_m = 0.15;
  double look_ahead_s = 1.0;
  int clearance_steps = 2;
};

struct MopRewardSettings {
  double speed_tolerance_mps = 1.5;
  double headway_s = 1.2;
  double standstill_gap_m = 3.0;
  // A wider range leaves it to chance how far back a MoP follows (docs/results.md).
  double near_low = 0.6;
  double near_high = 1.0;
  double near_high_offset_m = 2.0;
  double acceleration_penalty = 0.05;
};

struct BpRewardSettings {
  std::vector<double> thresholds_mps = {10.0, 11.0, 12.0};
  double left_change = -5.0;
  double collision_shaping = -10.0;
  double lane_change_shaping = -5.0;
};

struct RulesSettings {
  double slow_leader_mps = 2.0;
  double leader_range_m = 80.0;
  double gain_mps = 0.25;
  double front_gap_s = 0.2;
  double back_gap_s = 0.2;
  double gap_min_m = 2.5;
  double return_right_s = 2.0;
};

struct RandomBpSettings {
  int hold_steps_min = 40;
  int hold_steps_max = 160;
  double flicker_share = 0.2;
  int flicker_steps = 30;
  int flicker_hold_max = 4;
};

struct DrivingSettings {
  RoadSettings road;
  EgoSettings ego;
  PlannerSettings planner;
  MopRewardSettings mop_reward;
  BpRewardSettings bp_reward;
  RulesSettings rules;
  RandomBpSettings random_bp;
  double step_s = 1.0;
};

}  // namespace corridor
