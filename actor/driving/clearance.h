// How near other vehicles will be after each of the MoP's moves, if they go on as they do now.
#pragma once

#include <span>

#include "actor/driving/scene.h"
#include "proto/settings/settings.h"

namespace corridor::driving {

// The separation (actor/driving/prediction.h) of the ego, driving on its trajectory, and the
// nearest other vehicle, driving on at its speed and lateral speed; at most kClearanceMax_m.
inline constexpr double kClearanceMax_m = 2.0;

// For corridor changes -1, 0, +1 (outer), with the hardest braking and with the set-point as it is
// (middle), repeated for 1, 2, ... planner.clearance_steps steps (inner): the clearance at the end
// of each step. `out` has 6 * clearance_steps values.
void predicted_clearances_m(const Scene& scene, const DrivingSettings& settings,
                            std::span<double> out);

}  // namespace corridor::driving
