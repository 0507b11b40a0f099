// What an experiment trains and evaluates, and by which commands.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "cluster/experiment_file.h"
#include "cluster/launch/plan.h"
#include "proto/settings/settings.h"

namespace corridor::cluster {

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
std::vector<EvaluationJob> jobs_of(const TrainingRun& run, const Experiment& experiment,
                                   WorldKind world);

}  // namespace corridor::cluster
