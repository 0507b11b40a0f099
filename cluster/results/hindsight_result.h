// What corridor-actor wrote when it looked back on collisions, as values; the table. Pure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cluster/results/table.h"
#include "proto/base/json_fwd.h"

namespace corridor::cluster {

// One planner pair on one evaluation seed. Counts are of collisions.
struct HindsightResult {
  std::string planner;
  std::uint64_t seed = 0;
  std::int64_t steps = 0;
  std::int64_t collisions = 0;
  std::vector<std::int64_t> avoidable_by_last;  // by the last 1, 2, ... actions
  std::int64_t avoidable_by_reacting = 0;       // to what could be seen
  std::int64_t unavoidable_by_reacting = 0;
  std::int64_t undecided = 0;  // neither of the two: a search was given up

  bool operator==(const HindsightResult&) const = default;
};

// Throws Failure naming `name` (the file) when a field is missing or wrong.
HindsightResult parse_hindsight(const Json& json, const std::string& name);

// One row a planner (its seeds together, planners in the order in which they come): collisions per
// 1000 steps, the shares that could have been avoided, and the floor: those of which it is proven
// that no reaction avoids them. Intervals are exact Poisson. All results have searched equally many
// actions (CHECK).
Table hindsight_table(const std::vector<HindsightResult>& results);

}  // namespace corridor::cluster
