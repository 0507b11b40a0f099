// SPDX-License-Identifier: Apache-2.0
// Several instants of driving on one picture. Pure.
#pragma once

#include <vector>

#include "cluster/pictures/canvas.h"
#include "cluster/pictures/clip.h"

namespace corridor::cluster {

// The road at several instants, one below the other: of a single clip every `interval_s` to its
// end, of several clips the end of each. Throws Failure when these are more than 200.
Canvas contact_sheet(const std::vector<Clip>& clips, double interval_s);

}  // namespace corridor::cluster
