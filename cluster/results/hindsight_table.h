// The table of collisions that could have been avoided. Pure.
#pragma once

#include <vector>

#include "cluster/results/table.h"
#include "proto/run/hindsight_record.h"

namespace corridor::cluster {

// One row a planner (its seeds together, planners in the order in which they come): collisions per
// 1000 steps, the shares that could have been avoided, and the floor: those of which it is proven
// that no reaction avoids them. Intervals are exact Poisson. All records have searched equally many
// actions (CHECK), and there is one (CHECK).
Table hindsight_table(const std::vector<HindsightRecord>& records);

}  // namespace corridor::cluster
