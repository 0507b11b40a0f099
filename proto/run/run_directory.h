// SPDX-License-Identifier: Apache-2.0
// Where everything of a run lies.
//
//   config.toml                  the resolved scenario
//   manifest.json                proto/run/manifest.h
//   sumo/                        network and traffic for SUMO (scenarios/)
//   log/<process>.log            one text log a process
//   metrics/<process>.jsonl      one JSON-lines file a process (proto/run/metrics.h)
//   networks.safetensors         networks that were given to it (proto/run/networks.h)
//   checkpoints/<round>/         proto/run/checkpoints.h
//   evaluation/                  by EvaluationName and EpisodeName (proto/run/episode_name.h):
//     <evaluation>.json          proto/run/evaluation_record.h
//     episodes/<episode>.json    proto/run/recorded_episode.h
//     hindsight/<evaluation>.json  proto/run/hindsight_record.h
//   scenarios/<name>/            the same, of evaluations in another scenario's world
//   tensorboard/                 event files (cluster/watch/tensorboard.h)
//   report/                      what `corridor report` wrote
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "proto/run/episode_name.h"
#include "proto/settings/sumo_names.h"
#include "proto/system/files.h"

namespace corridor {

// The processes of a training, as their logs and metrics files are called; all actors together.
inline constexpr const char* kLearnerName = "learner";
inline constexpr const char* kReplayName = "replay";
inline constexpr const char* kActorName = "actor";
std::string actor_name(int index);  // "actor-0"

// Their programs.
inline constexpr const char* kLearnerProgram = "corridor-learner";
inline constexpr const char* kReplayProgram = "corridor-replay";
inline constexpr const char* kActorProgram = "corridor-actor";

// What has made a folder a run, once it is there.
inline constexpr const char* kManifestFile = "manifest.json";

class RunDirectory {
 public:
  // Throws Failure when it is there already, with anything in it (saying what to do), or cannot be
  // created. Others see it half filled: NewRun is for where that matters.
  static RunDirectory create(const std::filesystem::path& root);
  // Throws Failure when it is missing or no run directory (no config.toml or manifest.json).
  static RunDirectory open(const std::filesystem::path& root);

  // Those of its folders that are missing: version control keeps no empty ones. Throws Failure.
  void create_folders() const;
  // Those of its folders that are empty go.
  void remove_empty_folders() const;

  // What processes of the training that were killed left half-written. Nobody else may be training
  // there (cluster/launch/run_lock.h); what evaluations write is left alone.
  void remove_leftovers() const;

  const std::filesystem::path& root() const { return root_; }
  std::filesystem::path config() const { return root_ / "config.toml"; }
  std::filesystem::path manifest() const { return root_ / kManifestFile; }
  std::filesystem::path network() const { return root_ / "sumo" / kSumoNetworkFile; }
  std::filesystem::path routes() const { return root_ / "sumo" / kSumoRoutesFile; }
  std::filesystem::path log(std::string_view process) const;
  std::filesystem::path metrics(std::string_view process) const;
  std::filesystem::path networks() const { return root_ / "networks.safetensors"; }
  std::filesystem::path checkpoints() const { return root_ / "checkpoints"; }
  std::filesystem::path tensorboard() const { return root_ / "tensorboard"; }
  std::filesystem::path evaluation() const { return root_ / "evaluation"; }
  std::filesystem::path episodes() const { return root_ / "evaluation" / "episodes"; }
  std::filesystem::path hindsight() const { return root_ / "evaluation" / "hindsight"; }
  std::filesystem::path evaluation(const EvaluationName& name) const;
  std::filesystem::path episode(const EpisodeName& name) const;
  std::filesystem::path hindsight(const EvaluationName& name) const;
  // Where a run's networks were driven in other scenarios: a run directory for each, by its name.
  static std::filesystem::path scenarios(const std::filesystem::path& root) {
    return root / "scenarios";
  }

 private:
  explicit RunDirectory(std::filesystem::path root) : root_(std::move(root)) {}
  std::filesystem::path root_;
};

// A run directory that gets its name when it is whole.
class NewRun {
 public:
  // Throws Failure as RunDirectory::create.
  explicit NewRun(const std::filesystem::path& root);
  const RunDirectory& directory() const { return directory_; }  // to be filled
  // False when somebody else has been first; what they made is left alone.
  bool publish();

 private:
  NewFolder folder_;
  RunDirectory directory_;
};

}  // namespace corridor
