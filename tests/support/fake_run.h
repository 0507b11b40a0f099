// SPDX-License-Identifier: Apache-2.0
// A run directory as after a training, without the training.
#pragma once

#include <string>

#include "proto/config/config_values.h"
#include "proto/run/evaluation_record.h"
#include "proto/run/metrics.h"
#include "proto/run/run_directory.h"
#include "proto/system/files.h"
#include "tests/support/some_manifest.h"

namespace corridor::testing_support {

inline RunConfig fake_run_config(std::uint64_t seed) {
  RunConfig config;
  config.run.seed = seed;
  return config;
}

// Two actors whose MoP reward rises from `reward` on, and a learner; two evaluations.
inline RunDirectory make_fake_run(const std::filesystem::path& root, const RunConfig& config,
                                  double reward = 100.0) {
  const RunDirectory directory = RunDirectory::create(root);
  write_file(directory.config(), to_toml(config));
  write_manifest(directory, some_manifest(config));
  for (const int actor : {0, 1}) {
    MetricsWriter writer(directory.metrics(actor_name(actor)));
    for (std::uint64_t line = 1; line <= 10; ++line) {
      writer.write("MoP", 8 * line - 1, static_cast<std::int64_t>(4096 * line),
                   {{metric::kRewardPer1000, reward + static_cast<double>(line)},
                    {metric::kCollisionsPer1000, 2.0},
                    {metric::kEpisodicReturn, 40.0},
                    {metric::kEpisodes, 3.0}});
    }
  }
  MetricsWriter learner(directory.metrics(kLearnerName));
  learner.write("MoP", 7, 4096, {{metric::kTdLoss, 0.25}, {metric::kGreedyRewardPer1000, 90.0}});
  for (const char* planner : {"rules", "random+rules"}) {
    const EpisodeRecord episode{
        1000, 500.0, 800.0, 1, 9, 2, 1e4, {500, 300, 200}, 0, CollisionKind::kRearEnded, 0};
    write_evaluation(directory, evaluation_of({planner, 1002}, 1.0, {episode}));
  }
  return directory;
}

}  // namespace corridor::testing_support
