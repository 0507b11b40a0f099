// SPDX-License-Identifier: Apache-2.0
// `corridor hindsight`: how many collisions could any driver have avoided?
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "proto/run/hindsight_record.h"

namespace corridor::cluster {

struct HindsightOptions {
  std::filesystem::path run = {};          // or one of its scenarios/<name>
  std::vector<std::string> planners = {};  // empty: those evaluated by default
  std::vector<std::uint64_t> seeds = {};   // empty: [evaluation] seeds
  HindsightLimits limits = {};             // of a search
  std::filesystem::path out = {};          // folder for results; empty: beside the evaluation
  std::optional<int> jobs = {};            // processes at a time; else the number of cores
};

// Looks back on every collision of what has been evaluated and prints the table. Returns the exit
// status: 0, or 128 + signal when stopped by one. Throws Failure for planners and seeds that have
// not been evaluated, and when a process fails.
int hindsight(const HindsightOptions& options);

}  // namespace corridor::cluster
