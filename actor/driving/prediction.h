// Where the ego and the vehicles around it will be, and how near each other.
#pragma once

#include "actor/driving/action.h"
#include "actor/driving/scene.h"
#include "proto/settings.h"

namespace corridor::driving {

// The ego after it has driven one step towards the action's target.
Ego after_step(const Ego& ego, const MopAction& action, const DrivingSettings& settings);

// The separation of two rectangles along the road's axes: the larger of the distances along and
// across the road, < 0 where they overlap.
double separation_m(const Ego& ego, const Vehicle& other, const EgoSettings& size);

}  // namespace corridor::driving
