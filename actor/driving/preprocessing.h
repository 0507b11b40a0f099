// State pre-processing (paper section III-C): which corridors the shared MoP is shown for a skill,
// so that earning its reward, which is in the window's middle, carries the skill out.
#pragma once

#include <vector>

#include "actor/driving/corridors.h"
#include "actor/driving/scene.h"
#include "proto/settings/named_networks.h"

namespace corridor::driving {

// As many corridors as one lane has.
struct Window {
  int first = 0;           // the road's corridor at position 0; may lie off the road
  std::vector<bool> open;  // [N_c]; a closed corridor shows gaps 0 and must not be entered
  NetworkId network = NetworkId::kMop;  // that is to drive in it

  int size() const { return static_cast<int>(open.size()); }
  int middle() const { return size() / 2; }
  int position_of(int corridor) const { return corridor - first; }
  bool contains(int corridor) const { return corridor >= first && corridor < first + size(); }
  bool is_open(int corridor) const {
    return contains(corridor) && open[static_cast<std::size_t>(position_of(corridor))];
  }
};

// A window from that corridor on; those are open in which the ego stays between the two edges.
Window window_from(int first_corridor, double right_edge_m, double left_edge_m,
                   const DrivingSettings& settings);

// Of a skill that keeps to its lane: the one that the ego's centre is in; corridors in which the
// ego would intrude on another lane or leave the road are closed.
Window keep_window(int lane_change, const Ego& ego, const DrivingSettings& settings);

// Of a skill that leads to the lane `lane_change` (-1 or 1) to the left: placed so that the ego is
// one corridor off its middle, opposite to the direction of change; only corridors in which the ego
// would leave the road are closed.
Window switch_window(int lane_change, const Ego& ego, const DrivingSettings& settings);

}  // namespace corridor::driving
