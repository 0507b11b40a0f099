// SPDX-License-Identifier: Apache-2.0
// How many batches the learner may train on: so many that each row is drawn samples_per_insert
// times on average. A pure function of the rows inserted: it waits for nothing, holds no counter
// of its own, and cannot get out of step with the store over a restart.
//
// Nothing is granted before the replay holds minimum_size rows (and at least one whole batch). The
// rows before that one are not made up for later: training starts at the asked ratio, without a
// burst on the few first rows.
#pragma once

#include <cstdint>

#include "proto/settings/settings.h"

namespace corridor::replay {

// Of `inserted` rows in this phase, those that count: from the one on that reaches the minimum.
std::uint64_t counted_rows(const DqnSettings& settings, std::uint64_t inserted);

// Batches granted in all by the time `inserted` rows are in:
// floor(counted_rows * samples_per_insert / batch_size). Never falls. A block is granted the
// difference that its rows make.
std::uint64_t granted_batches(const DqnSettings& settings, std::uint64_t inserted);

}  // namespace corridor::replay
