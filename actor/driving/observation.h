// SPDX-License-Identifier: Apache-2.0
// What the two networks are fed. One index table each; sizes in proto/settings/transition.h.
#pragma once

#include <span>
#include <vector>

#include "actor/driving/corridors.h"
#include "actor/driving/scene.h"
#include "actor/driving/skills.h"

namespace corridor::driving {

// Scaling, so that inputs are of order 1: speeds / speed limit; a gap g as g / (g + 15 m); a rate
// as rate / 8 m/s, clipped to [-1, 1].

// The motion planner's observation for a window of N corridors (paper section III-C, "input
// states"): window positions from right to left.
//   0                  ego speed
//   1                  speed set-point
//   2                  the BP's target speed
//   3 + 5 c + 0        1 where the ego is in the window's corridor c, else 0
//   3 + 5 c + 1        front gap        (0 where the corridor is closed)
//   3 + 5 c + 2        front gap's rate (0 where closed)
//   3 + 5 c + 3        back gap
//   3 + 5 c + 4        back gap's rate
//   3 + 5 N + i        the i-th predicted clearance (actor/driving/prediction.h) / 2 m, in [-1, 1]
struct MopIndex {
  static constexpr int kSpeed = 0;
  static constexpr int kSetPoint = 1;
  static constexpr int kTargetSpeed = 2;
  static constexpr int corridor(int position) { return kMopScalars + kMopPerCorridor * position; }
  static constexpr int kInCorridor = 0;
  static constexpr int kFrontGap = 1;
  static constexpr int kFrontRate = 2;
  static constexpr int kBackGap = 3;
  static constexpr int kBackRate = 4;
};

// `gaps` of the whole road (corridor_gaps). `out` has mop_shape().observations floats.
void observe_mop(const Scene& scene, const std::vector<CorridorGaps>& gaps, const Window& window,
                 const DrivingSettings& settings, std::span<float> out);

// The behaviour planner's observation (paper section III-B): with L lanes,
//   0                  ego speed
//   1                  speed set-point
//   2                  ego's offset from its lane's centre / half a lane width, left > 0
//   3 .. 3+L-1         ego lane, one-hot
//   then K             previous command of K skills, one-hot
//   then 3 x 5         lanes right, own, left: exists (1 or 0), front gap, front rate, back gap,
//                      back rate (all 0 where it does not exist)
struct BpIndex {
  static constexpr int kSpeed = 0;
  static constexpr int kSetPoint = 1;
  static constexpr int kOffset = 2;
  static constexpr int kLane = 3;
  static constexpr int previous_command(int lanes) { return kBpScalars + lanes; }
  // which: 0 right, 1 own, 2 left
  static constexpr int lane(int lanes, int which, int skills = kSkillCount) {
    return kBpScalars + lanes + skills + kBpPerLane * which;
  }

  static constexpr int kExists = 0;
  static constexpr int kFrontGap = 1;
  static constexpr int kFrontRate = 2;
  static constexpr int kBackGap = 3;
  static constexpr int kBackRate = 4;
};

// `out` has bp_shape().observations floats; `skills` as there.
void observe_bp(const Scene& scene, Command previous, const DrivingSettings& settings,
                std::span<float> out, int skills = kSkillCount);

}  // namespace corridor::driving
