// SPDX-License-Identifier: Apache-2.0
// What run directories hold, as values.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cluster/results/training_curves.h"
#include "proto/run/evaluation_record.h"
#include "proto/settings/settings.h"

namespace corridor::cluster {

struct RunRecord {
  std::filesystem::path root;
  RunConfig config;
  std::string scenario;  // the name of its file, "paper"
  // Of manifest.json: (name, value) of what the run was made with, versions included.
  std::vector<std::pair<std::string, std::string>> made_with;
  std::uint64_t rounds_done = 0;           // in the newest checkpoint
  std::optional<std::string> fingerprint;  // of it
  std::vector<ProcessMetrics> actors;
  std::vector<ProcessMetrics> learner;  // one file
  // By the world that was driven in: its own has the name "", others that of their scenario.
  std::map<std::string, std::vector<EvaluationRecord>> evaluations;
  std::map<std::string, RunConfig> worlds;  // their settings
  // Those of these worlds that are as in training: "", and scenarios with the same settings.
  std::set<std::string> worlds_of_training;

  // The root of the run directory that was driven in such a world.
  std::filesystem::path driven_in(const std::string& world) const;
};

// Throws Failure when there is no run, nothing was trained yet, or a file is damaged.
RunRecord read_run(const std::filesystem::path& root);

// The runs of one training, each with another seed: their curves can be averaged.
struct RunGroup {
  std::string label;            // the scenario's name; "paper (2)" for a second training of it
  std::vector<RunRecord> runs;  // by seed
};
// Throws Failure when two runs are the same training with the same seed.
std::vector<RunGroup> grouped_runs(std::vector<RunRecord> runs);

}  // namespace corridor::cluster
