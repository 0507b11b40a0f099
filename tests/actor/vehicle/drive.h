// SPDX-License-Identifier: Apache-2.0
// Time for cars in tests.
#pragma once

#include <cmath>

#include "actor/vehicle/vehicle.h"

namespace corridor::vehicle {

inline void drive(Vehicle& car, double time_s) {
  for (long i = 0; i < std::lround(time_s / car.time_step_s()); ++i) car.step();
}

}  // namespace corridor::vehicle
