// SPDX-License-Identifier: Apache-2.0
// The road from above around the ego: lanes, vehicles with their speeds in km/h and, where a
// planner decided, the corridors that the MoP was shown, as far as they are free, and its
// trajectory. Pure.
#pragma once

#include "cluster/pictures/canvas.h"
#include "cluster/pictures/clip.h"

namespace corridor::cluster {

struct RoadView {
  double width = 1232.0;                   // pixels
  double behind_m = 35.0, ahead_m = 65.0;  // what shows, from the ego's front bumper
  bool hit_stands_out_before = false;      // whom the ego collides with; else only when it does
};

// At that time of the clip; of one clip all are equally high.
Canvas road_from_above(const Clip& clip, double time_s, const RoadView& view);

}  // namespace corridor::cluster
