// `corridor evaluate` and `corridor redrive`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cluster/launch/plan.h"
#include "proto/run/run_directory.h"
#include "proto/settings/settings.h"

namespace corridor::cluster {

// A world to drive in: a scenario's, with changes.
struct EvaluationWorld {
  std::filesystem::path scenario = {};     // empty: the run's own
  std::vector<std::string> settings = {};  // table.key=value, over the scenario

  // "paper", "paper+world=slip+friction=0.5"; `own` is the name of the run's scenario.
  std::string name(const std::string& own) const;
};

struct EvaluateOptions {
  std::filesystem::path run = {};
  EvaluationWorld world = {};              // with neither: the run's own, in its own directory
  std::vector<std::string> planners = {};  // empty: all
  std::optional<std::int64_t> steps =
      {};                                 // for each planner and seed = {}; else [evaluation] steps
  std::vector<std::uint64_t> seeds = {};  // empty: [evaluation] seeds
  std::optional<int> jobs = {};           // processes at a time = {}; else the number of cores
  std::filesystem::path json = {};        // empty: none
  std::filesystem::path fcd = {};         // directory of SUMO's trajectories = {}; empty: none
};

// Where a run's planners are evaluated in another world, RUN/scenarios/<its name>: a run directory
// without checkpoints. Road, traffic, simulation, ego, dynamics, planner.corridor_change_s, BP
// reward and [evaluation] are the world's, all else the run's. Throws Failure when the run's
// networks do not fit that world, or when the directory holds what was driven with other settings.
RunDirectory world_directory(const RunDirectory& run, const EvaluationWorld& world);

// The run itself where the world is its own, else world_directory().
RunDirectory directory_to_drive_in(const RunDirectory& run, const EvaluationWorld& world);

// Writes SUMO's files where they are missing: an exported run has none.
void complete_sumo_files(const RunDirectory& directory, const RunConfig& config);

// Drives each planner on the test episodes of each seed and prints the table. Returns the exit
// status: 0, or 128 + signal when stopped by one. Throws Failure for planners that there are not or
// that this run cannot drive yet, and when a process fails.
int evaluate(const EvaluateOptions& options);

// Every planner with every seed: those chosen or, where none are, the pairs evaluated by default
// and [evaluation] seeds. Throws Failure for planners that there are not, and for what is given
// twice.
std::vector<EvaluationJob> chosen_jobs(std::vector<std::string> planners,
                                       std::vector<std::uint64_t> seeds, std::int64_t steps,
                                       const RunConfig& config);

// --jobs, or the number of cores. Throws Failure when it is less than 1.
int parallel_jobs(std::optional<int> jobs);

// Throws Failure when the run's newest checkpoint does not have what the planner drives with.
void check_can_drive(const std::string& planner, const RunDirectory& directory,
                     const RunConfig& config);

// Drives a recorded episode again: becomes corridor-actor, whose status is 0 when the trajectory is
// the recorded one. Returns only by throwing Failure.
[[noreturn]] void redrive(const std::filesystem::path& run, const std::string& episode);

// A file's path, or a name as in evaluation/episodes ("rules_1001_3"). Throws Failure when it is
// neither.
std::filesystem::path find_episode(const RunDirectory& directory, const std::string& episode);

}  // namespace corridor::cluster
