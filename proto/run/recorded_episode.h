// SPDX-License-Identifier: Apache-2.0
// An episode as an evaluation drove it, to be driven again:
// evaluation/episodes/<planner>_<seed>_<episode>.json.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "proto/run/episode_name.h"
#include "proto/run/evaluation_record.h"
#include "proto/run/run_directory.h"

namespace corridor {

struct RecordedEpisode {
  std::string planner;
  std::uint64_t evaluation_seed = 0;
  std::uint64_t episode = 0;       // its index in the evaluation
  std::uint64_t episode_seed = 0;  // of the traffic
  bool driven_by_world = false;
  std::vector<std::uint8_t> actions;  // one a step; none where the world drove
  std::string trajectory_hash;        // in hex
  EpisodeRecord summary;

  EpisodeName name() const { return {planner, evaluation_seed, episode}; }

  template <typename Self, typename Field>
  static void fields(Self& self, Field field) {
    field("planner", self.planner);
    field("evaluation_seed", self.evaluation_seed);
    field("episode", self.episode);
    field("episode_seed", self.episode_seed);
    field("driven_by_world", self.driven_by_world);
    field("actions", self.actions);
    field("trajectory_hash", self.trajectory_hash);
    field("summary", self.summary);
  }
  void check() const;
  bool operator==(const RecordedEpisode&) const = default;
};

// Throws Failure when the disk is full.
void write_recorded_episode(const RunDirectory& directory, const RecordedEpisode& episode);
// Throws Failure when the file is no episode.
RecordedEpisode read_recorded_episode(const std::filesystem::path& file);

}  // namespace corridor
