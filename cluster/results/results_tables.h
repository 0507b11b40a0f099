// SPDX-License-Identifier: Apache-2.0
// What evaluations came to -> tables. Pure.
#pragma once

#include <string>
#include <vector>

#include "cluster/results/results.h"
#include "cluster/results/table.h"
#include "proto/run/hindsight_record.h"
#include "proto/settings/settings.h"

namespace corridor::cluster {

// Of one scenario's arms: sums per 1000 steps; collisions by kind; figures per km, lane shares and
// seeds; ratios to rules and to sumo where they are among the arms, with the ratios of the paper's
// Table I as last row.
std::vector<Table> results_tables(const std::vector<Arm>& arms);

// What a table is about, in a sentence: traffic, blind drivers, the ego's motion, the step.
std::string world_text(const RunConfig& config);

// The paper's Table I.
Table paper_table();

// One row a planner (its seeds together, planners in the order in which they come): collisions per
// 1000 steps, the shares that could have been avoided, and the floor: those of which it is proven
// that no reaction avoids them. Intervals are exact Poisson. All records have searched equally many
// actions (CHECK), and there is one (CHECK).
Table hindsight_table(const std::vector<HindsightRecord>& records);

}  // namespace corridor::cluster
