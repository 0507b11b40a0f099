// What the rule-based planners reckon with on the way to a leader. Pure arithmetic.
#pragma once

#include "actor/driving/corridors.h"
#include "proto/settings/settings.h"

namespace corridor::driving {

inline constexpr double kComfortBraking_mps2 = 3.0;  // planned with

double braking_way_m(double speed_mps, double braking_mps2);

// The way lost to a vehicle that closes in, until the speeds are equal.
double closing_way_m(double rate_mps, double braking_mps2);

// The distance to follow at, d of the MoP's reward.
double headway_m(double speed_mps, const DrivingSettings& settings);

// The speed to be had behind a leader for a while: the limit where none is in range.
double promise_mps(const CorridorGaps& gaps, const Ego& ego, const DrivingSettings& settings);

}  // namespace corridor::driving
