// SPDX-License-Identifier: Apache-2.0
// `corridor evaluate` and `corridor redrive`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cluster/evaluation_world.h"
#include "proto/run/actor_task.h"
#include "proto/settings/settings.h"

namespace corridor::cluster {

struct EvaluateOptions {
  std::filesystem::path run = {};
  EvaluationWorld world = {};              // with neither: the run's own, in its own directory
  std::vector<std::string> planners = {};  // empty: all
  std::optional<std::int64_t> steps = {};  // for each planner and seed; else [evaluation] steps
  std::vector<std::uint64_t> seeds = {};   // empty: [evaluation] seeds
  std::optional<int> jobs = {};            // processes at a time; else the number of cores
  std::filesystem::path out = {};          // folder for results; empty: results_folder
  std::filesystem::path json = {};         // empty: none; "-": standard output
  std::filesystem::path fcd = {};          // directory of SUMO's trajectories; empty: none
};

// Drives each planner on the test episodes of each seed and prints the table. Returns the exit
// status: 0, or 128 + signal when stopped by one. Throws Failure for planners that there are not or
// that this run cannot drive yet, and when a process fails.
int evaluate(const EvaluateOptions& options);

// Every planner with every seed: those chosen or, where none are, the pairs evaluated by default
// and [evaluation] seeds. Throws Failure for planners that there are not, and for what is given
// twice.
std::vector<EvaluateTask> chosen_tasks(std::vector<std::string> planners,
                                       std::vector<std::uint64_t> seeds, std::int64_t steps,
                                       const RunConfig& config);

// --jobs, or the number of cores. Throws Failure when it is less than 1.
int parallel_jobs(std::optional<int> jobs);

// Drives a recorded episode again: becomes corridor-actor, whose status is 0 when the trajectory is
// the recorded one. Returns only by throwing Failure.
[[noreturn]] void redrive(const std::filesystem::path& run, const std::string& episode);

}  // namespace corridor::cluster
