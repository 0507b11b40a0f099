// SPDX-License-Identifier: Apache-2.0
// The smooth curve from where the ego is to the target corridor, extended along it as the ego moves
// (paper section III-C, "Trajectory generator").
#pragma once

#include "actor/driving/action.h"
#include "actor/driving/scene.h"

namespace corridor::driving {

struct TrajectoryPoint {
  double s_m = 0.0;
  double d_m = 0.0;
  double speed_mps = 0.0;
  double acceleration_mps2 = 0.0;  // at this instant: 0 once the set-point is reached
  double lateral_speed_mps = 0.0;
  double lateral_acceleration_mps2 = 0.0;
};

// Along the road: constant acceleration within the ego's limits up to the set-point, which is then
// held (exact integration, never backwards). Across it: a quintic that starts with the ego's
// position, lateral speed and acceleration and arrives exactly at the corridor's centre without
// lateral speed or acceleration; then straight on. It takes corridor_change_s for each corridor of
// distance, to which moving away adds the way to turn round in, and at least a step, so that
// planning anew at every step arrives too.
class Trajectory {
 public:
  Trajectory(const Ego& ego, const Target& target, const DrivingSettings& settings);

  // The state `t_s` >= 0 after the start. Defined for all times: the curve never ends.
  TrajectoryPoint at(double t_s) const;

  const Target& target() const { return target_; }
  double lateral_duration_s() const { return lateral_duration_s_; }

 private:
  Target target_;
  double s_m_ = 0.0;
  double speed_mps_ = 0.0;
  double acceleration_mps2_ = 0.0;  // signed, until the set-point is reached
  double ramp_s_ = 0.0;             // time at which it is reached
  double destination_m_ = 0.0;      // the target corridor's centre
  double lateral_duration_s_ = 0.0;
  double lateral_[6] = {};  // coefficients of d(t), constant first
};

}  // namespace corridor::driving
