// SPDX-License-Identifier: Apache-2.0
// The MoP's actions, and action post-processing (paper section III-C): relative corridor and speed
// into absolute ones.
#pragma once

#include <cstdint>

#include "actor/driving/corridors.h"
#include "actor/driving/scene.h"
#include "proto/settings/transition.h"

namespace corridor::driving {

// Action index = 3 * (index into planner.speed_changes_mps) + (corridor change + 1):
//   corridor change -1 (right), 0, +1 (left).
struct MopAction {
  int corridor_change = 0;
  int speed_change = 0;  // index into planner.speed_changes_mps
  bool operator==(const MopAction&) const = default;
};
MopAction mop_action(int index);
int index_of(const MopAction& action);

// The speed change that keeps the set-point as it is, or comes nearest to that.
int unchanged_speed(const DrivingSettings& settings);

// Where the trajectory is to lead: a corridor of the road and a speed.
struct Target {
  int corridor = 0;
  double set_point_mps = 0.0;
  bool operator==(const Target&) const = default;
};

// Clamped to the corridors in which the ego stays on the road, and to [0, speed limit].
Target target_for(const MopAction& action, const Ego& ego, const DrivingSettings& settings);

// What one step of an episode was driven with, in one byte: the action list that, with the
// episode's seed, drives an episode again. (MoP action) * `skills` + command; at most 255, which
// the configuration's check guarantees.
std::uint8_t pack(Command command, int mop_action_index, int skills = kSkillCount);
struct StepAction {
  Command command = Command::kKeep;
  int mop_action = 0;
};
StepAction unpack(std::uint8_t packed, int skills = kSkillCount);

}  // namespace corridor::driving
