// SPDX-License-Identifier: Apache-2.0
// Runs -> the figures of a report. Pure.
#pragma once

#include <vector>

#include "cluster/pictures/figures.h"
#include "cluster/report/run_record.h"

namespace corridor::cluster {

// For each phase that has begun: the paper's training figures (reward and collisions per 1000
// steps, reward per episode, of the exploring actors, with the level of the rules where they were
// evaluated: `random+rules` for the MoP, which is trained under a random BP, `rules` for the BP),
// the learner's loss and values, and the greedy evaluations in between. Each group is one curve.
std::vector<Figure> training_figures(const std::vector<RunGroup>& groups);

}  // namespace corridor::cluster
