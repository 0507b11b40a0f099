// A run directory as after a training, without the training.
#pragma once

#include <string>

#include "cluster/launch/manifest.h"
#include "proto/base/json.h"
#include "proto/config/config_values.h"
#include "proto/run/metrics.h"
#include "proto/run/run_directory.h"
#include "proto/system/files.h"

namespace corridor::testing_support {

inline RunConfig fake_run_config(std::uint64_t seed) {
  RunConfig config;
  config.run.seed = seed;
  return config;
}

// Two actors whose MoP reward rises from `reward` on, and a learner; two evaluations. The
// scenario's file is scenarios/fake.toml.
inline RunDirectory make_fake_run(const std::filesystem::path& root, const RunConfig& config,
                                  double reward = 100.0) {
  const RunDirectory directory = RunDirectory::create(root);
  const std::string text = to_toml(config);
  write_file(directory.config(), text);
  write_file(directory.manifest(),
             cluster::describe_run("secret", config.run.seed, "scenarios/fake.toml", text).dump(2));
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
    const Json episode = {{"steps", 1000},   {"bp_reward", 500.0}, {"mop_reward", 800.0},
                          {"collisions", 1}, {"lane_changes", 9},  {"hard_brakes", 2},
                          {"bypasses", 0},   {"distance_m", 1e4},  {"lane_steps", {500, 300, 200}}};
    const Json result = {{"planner", planner},
                         {"seed", 1002},
                         {"steps", 1000},
                         {"episodes", 1},
                         {"bp_reward_per_1000", 500.0},
                         {"collisions", 1},
                         {"collisions_by_kind",
                          {{"rear_ended", 1},
                           {"rear_ending", 0},
                           {"side_by_other", 0},
                           {"side_by_ego", 0},
                           {"off_road", 0}}},
                         {"lane_changes", 9},
                         {"bypasses", 0},
                         {"mean_speed_kph", 36.0},
                         {"distance_km", 10.0},
                         {"per_episode", {episode}}};
    write_file(directory.evaluation() / (std::string(planner) + "_1002.json"), result.dump());
  }
  return directory;
}

}  // namespace corridor::testing_support
