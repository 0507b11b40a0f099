// State pre-processing (paper section III-C): which corridors the shared MoP is shown for a
// command, so that earning its reward, which is in the window's middle, carries the command out.
#pragma once

#include <vector>

#include "actor/driving/corridors.h"
#include "actor/driving/scene.h"

namespace corridor::driving {

// As many corridors as one lane has.
struct Window {
  int first = 0;           // the road's corridor at position 0; may lie off the road
  std::vector<bool> open;  // [N_c]; a closed corridor shows gaps 0 and must not be entered

  int size() const { return static_cast<int>(open.size()); }
  int middle() const { return size() / 2; }
  int position_of(int corridor) const { return corridor - first; }
  bool contains(int corridor) const { return corridor >= first && corridor < first + size(); }
  bool is_open(int corridor) const {
    return contains(corridor) && open[static_cast<std::size_t>(position_of(corridor))];
  }
};

// The command, or kKeep when it asks for a lane that does not exist (counted from the lane that the
// ego's centre is in).
Command feasible(Command command, const Ego& ego, const DrivingSettings& settings);

// kKeep: the lane that the ego's centre is in; corridors in which the ego would intrude on another
// lane or leave the road are closed. kLeft, kRight: the window is placed so that the ego is one
// corridor off its middle, opposite to the direction of change; only corridors in which the ego
// would leave the road are closed.
Window window_for(Command command, const Ego& ego, const DrivingSettings& settings);

}  // namespace corridor::driving
