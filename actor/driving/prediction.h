// SPDX-License-Identifier: Apache-2.0
// Where the ego and the vehicles around it will be, and how near each other.
#pragma once

#include <span>

#include "actor/driving/action.h"
#include "actor/driving/scene.h"
#include "proto/settings/settings.h"

namespace corridor::driving {

// The ego after it has driven one step towards the target; of an action, towards its target.
Ego after_step(const Ego& ego, const Target& target, const DrivingSettings& settings);
Ego after_step(const Ego& ego, const MopAction& action, const DrivingSettings& settings);

// How far one gets in that time, braking to a standstill; braking_mps2 0: going on.
double way_m(double speed_mps, double braking_mps2, double time_s);

// The separation of two rectangles along the road's axes: the larger of the distances along and
// across the road, < 0 where they overlap.
double separation_m(const Ego& ego, const Vehicle& other, const EgoSettings& size);

// The separation of the ego, driving on its trajectory, and the nearest other vehicle, driving on
// at its speed and lateral speed; at most kClearanceMax_m.
inline constexpr double kClearanceMax_m = 2.0;

// For corridor changes -1, 0, +1 (outer), with the hardest braking and with the set-point as it is
// (middle), repeated for 1, 2, ... planner.clearance_steps steps (inner): the clearance at the end
// of each step. `out` has 6 * clearance_steps values.
void predicted_clearances_m(const Scene& scene, const DrivingSettings& settings,
                            std::span<double> out);

}  // namespace corridor::driving
