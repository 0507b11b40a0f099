// What an experiment is made of: a TOML file beside the scenarios.
//
//   planners = ["hierarchical", "rules"]    # arms (proto/settings/planner_pairs.h)
//   training_seeds = [1, 2, 3, 4, 5]
//   evaluation_seeds = [1002, 1003, 1004]
//   evaluation_steps = 40_000               # for each arm, training seed and evaluation seed
//
//   [[training]]                            # one or more
//   name = "paper"
//   scenario = "../paper.toml"              # to train in; files are relative to this one
//   settings = ["mop.risk_weight=0"]        # over the scenario; none unless given
//   from = "other"                          # begins with the networks of that training, same seed
//   evaluate_in = ["../paper.toml", "../paper.toml dynamics.world=rigid"]    # settings over it
//   planners = ["hierarchical"]             # planners and training_seeds: for this one only
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "cluster/evaluation_world.h"

namespace corridor::cluster {

struct TrainingArm {
  std::string name;
  std::filesystem::path scenario;
  std::vector<std::string> settings;
  std::string from;  // name of an earlier one; empty: begins with random networks
  std::vector<EvaluationWorld> evaluate_in;
  std::vector<std::string> planners;
  std::vector<std::uint64_t> training_seeds;
};

struct Experiment {
  std::vector<TrainingArm> trainings;
  std::vector<std::uint64_t> evaluation_seeds;
  std::int64_t evaluation_steps = 0;
};

// Throws Failure naming file, key and what would be right: an unknown or missing key, a wrong type,
// an empty list, anything given twice, planners and scenarios that there are not, settings that
// contradict each other.
Experiment load_experiment(const std::filesystem::path& file);

}  // namespace corridor::cluster
