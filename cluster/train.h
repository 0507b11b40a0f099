// SPDX-License-Identifier: Apache-2.0
// `corridor train` and `corridor resume`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cluster/launch/describe_run.h"
#include "proto/run/manifest.h"

namespace corridor::cluster {

struct TrainOptions {
  std::filesystem::path scenario = {};
  std::filesystem::path run = {};
  std::filesystem::path from = {};         // run whose networks to begin with; empty: random ones
  std::optional<int> actors = {};          // run.actors
  std::optional<std::uint64_t> seed = {};  // run.seed
  std::vector<std::string> settings = {};  // "table.key=value", applied last
};

struct ResumeOptions {
  std::filesystem::path run = {};
  std::vector<std::string> settings = {};  // "table.key=value"
  bool allow_other_bits = false;           // by other libraries
};

// Both return the process's exit status: 0 when the training is complete, 128 + signal when it was
// stopped by one. Both throw Failure when anything goes wrong; nothing is then left running, and
// when training had not begun, no run directory is left. `program` is how people call this
// program, for what comes next.
//
// resume: settings may differ from those that the run began with, in config.toml or `settings`,
// where they do not change its result; others are refused by name, and so are other libraries than
// it was trained with, unless they are allowed. A phase may go on for longer than it was to, as
// long as no later one has begun. What has changed so is in the manifest. A damaged checkpoint is
// named and set aside, and the one before is used.
// `versions`: what is installed.
using Versions = std::function<RunVersions()>;
int train(const TrainOptions& options, const std::string& program,
          const Versions& versions = versions_here);
int resume(const ResumeOptions& options, const std::string& program,
           const Versions& versions = versions_here);

}  // namespace corridor::cluster
