// SPDX-License-Identifier: Apache-2.0
// Everything that the learner's future depends on, as one value, and that value's file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "learner/td_update.h"
#include "proto/run/networks.h"
#include "proto/run/tensor_file.h"
#include "proto/settings/schedule.h"
#include "proto/settings/settings.h"
#include "proto/wire/messages.h"

namespace corridor::learner {

// Parameters that were evaluated greedily.
struct Candidate {
  std::uint64_t version = 0;
  double score = 0.0;  // per 1000 steps; more is better
  std::vector<float> parameters;
  bool operator==(const Candidate&) const = default;
};

// Between two blocks. The phase in progress is next_round's, after the last round the last one.
struct LearnerState {
  std::uint64_t next_round = 0;    // blocks before it are done
  TdState td;                      // of the phase in progress
  std::vector<Weights> published;  // the newest two versions, ascending; one at the start
  std::optional<Candidate> best;   // of the phase in progress
  bool operator==(const LearnerState&) const = default;
};

Phase phase_in_progress(const Schedule& schedule, std::uint64_t next_round);

// Those that a user should drive with now: of the phase in progress the best so far, else the
// newest.
Networks networks_to_use(const LearnerState& state, Phase phase);

// Tensors "mop", "bp", by the networks' names: networks_to_use; metadata "mop.shape" ...: their
// NetworkShape in JSON, "phase" and "round". The other tensors are the state's members. Equal
// states give equal files.
TensorFile to_tensors(const LearnerState& state, const RunConfig& config);
// The inverse. Throws Failure naming `file` when something is missing or has another size than the
// configuration's networks.
LearnerState from_tensors(const TensorFile& tensors, const RunConfig& config,
                          const std::string& file);

}  // namespace corridor::learner
