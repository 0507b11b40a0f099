// SPDX-License-Identifier: Apache-2.0
// What an experiment is made of, a TOML file beside the scenarios, and what is trained and
// evaluated for it, by which commands.
//
//   planners = ["hierarchical", "rules"]    # arms (proto/settings/planner_pairs.h)
//   training_seeds = [1, 2, 3, 4, 5]
//   evaluation_seeds = [1002, 1003, 1004]
//   evaluation_steps = 40_000               # for each arm, training seed and evaluation seed
//   [[training]]                            # one or more; each after the one it begins with
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
#include "proto/run/actor_task.h"
#include "proto/settings/settings.h"

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

// One seed of one training.
struct TrainingRun {
  const TrainingArm* training = nullptr;  // in the Experiment, which outlives this
  std::uint64_t seed = 0;
  std::filesystem::path root;
  RunConfig config;

  std::string name() const;  // "paper-1"
};

// Every seed of every training, in the experiment's `directory`. Throws Failure for a wrong
// scenario.
std::vector<TrainingRun> runs_of(const Experiment& experiment,
                                 const std::filesystem::path& directory);

// `corridor train`, of a run that is not there yet; one that begins with another's networks does so
// with those of its own seed.
std::vector<std::string> train_command(const TrainingRun& run, const std::string& program);

// What a run's planners are evaluated on in such a world: those that learn nothing beside the first
// seed only, SUMO's driver only where it can drive.
std::vector<EvaluateTask> tasks_of(const TrainingRun& run, const Experiment& experiment,
                                   WorldKind world);

}  // namespace corridor::cluster
