// SPDX-License-Identifier: Apache-2.0
// Going around within a lane (paper figure "bypassing a vehicle that partially blocks the lane").
#pragma once

#include "actor/driving/scene.h"
#include "proto/settings/settings.h"

namespace corridor::driving {

// How many vehicles, objects among them, the ego has bypassed from one scene to the next: its front
// bumper has gone past theirs while its whole body stayed in the lane that their middle is in.
int bypasses(const Scene& before, const Scene& after, const DrivingSettings& settings);

}  // namespace corridor::driving
