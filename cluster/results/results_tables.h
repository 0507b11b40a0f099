// One scenario's arms -> tables. Pure.
#pragma once

#include <vector>

#include "cluster/results/results.h"
#include "cluster/results/table.h"

namespace corridor::cluster {

// Sums per 1000 steps; collisions by kind; figures per km, lane shares and seeds; ratios to rules
// and to sumo where they are among the arms, with the ratios of the paper's Table I as last row.
std::vector<Table> results_tables(const std::vector<Arm>& arms);

// The paper's Table I.
Table paper_table();

}  // namespace corridor::cluster
