// Where everything of a run lies, and how files get there whole.
//
//   config.toml                  the resolved scenario
//   manifest.json                run id, seed, versions, host
//   sumo/                        network and traffic for SUMO (scenarios/)
//   log/<process>.log            one text log a process
//   metrics/<process>.jsonl      one JSON-lines file a process (proto/metrics.h)
//   networks.safetensors         networks that were given to it (proto/networks.h)
//   checkpoints/<round>/         proto/checkpoints.h
//   evaluation/                  <planner>_<seed>.json; episodes/<planner>_<seed>_<episode>.json;
//                                hindsight/<planner>_<seed>.json
//   scenarios/<name>/            the same, of evaluations in another scenario's world
//   tensorboard/                 event files (cluster/tensorboard.h)
//   report/                      what `corridor report` wrote
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "proto/failure.h"

namespace corridor {

// Writes beside the target, syncs and renames: readers see the old file or the new one, whole.
// Throws Failure (disk full, read-only ...) with the path and the system's reason; the old file is
// then untouched and nothing is left beside it.
void write_file(const std::filesystem::path& file, std::string_view content);
// Throws Failure when missing or unreadable.
std::string read_file(const std::filesystem::path& file);
// Throws Failure naming the file when missing or not JSON.
nlohmann::json read_json(const std::filesystem::path& file);
// Makes what another program wrote survive a power failure.
void sync_file(const std::filesystem::path& file);
// Makes a rename or a new name in the directory survive one.
void sync_directory(const std::filesystem::path& directory);
// Turns the standard library's error into a Failure: "cannot <what> <path>: <reason>".
template <typename Action>
void on_disk(const char* what, const std::filesystem::path& path, const Action& action) {
  try {
    action();
  } catch (const std::filesystem::filesystem_error& error) {
    throw Failure("cannot {} {}: {}", what, path.string(), error.code().message());
  }
}

class RunDirectory {
 public:
  // Throws Failure when it exists already (saying what to do) or cannot be created.
  static RunDirectory create(const std::filesystem::path& root);
  // Creates those of its folders that are missing: version control keeps no empty ones. Throws
  // Failure when it is missing or no run directory (no config.toml or manifest.json).
  static RunDirectory open(const std::filesystem::path& root);

  // What processes that were killed left half-written. Nobody else may be using the directory
  // (cluster/run_lock.h).
  void remove_leftovers() const;

  const std::filesystem::path& root() const { return root_; }
  std::filesystem::path config() const { return root_ / "config.toml"; }
  std::filesystem::path manifest() const { return root_ / "manifest.json"; }
  std::filesystem::path network() const { return root_ / "sumo" / "road.net.xml"; }
  std::filesystem::path routes() const { return root_ / "sumo" / "traffic.rou.xml"; }
  std::filesystem::path log(std::string_view process) const;
  std::filesystem::path metrics(std::string_view process) const;
  std::filesystem::path networks() const { return root_ / "networks.safetensors"; }
  std::filesystem::path checkpoints() const { return root_ / "checkpoints"; }
  std::filesystem::path tensorboard() const { return root_ / "tensorboard"; }
  std::filesystem::path evaluation() const { return root_ / "evaluation"; }
  std::filesystem::path episodes() const { return root_ / "evaluation" / "episodes"; }
  std::filesystem::path hindsight() const { return root_ / "evaluation" / "hindsight"; }
  // Where a run's networks were driven in other scenarios: a run directory for each, by its name.
  static std::filesystem::path scenarios(const std::filesystem::path& root) {
    return root / "scenarios";
  }

 private:
  explicit RunDirectory(std::filesystem::path root) : root_(std::move(root)) {}
  std::filesystem::path root_;
};

// manifest.json of a run, as every process needs it.
struct RunManifest {
  std::string run_id;
};
RunManifest read_manifest(const RunDirectory& directory);

struct Addresses {
  std::string replay;
  std::string learner;
};
struct RunSettings;
// From [run] and the run id (of which ipc names show a hash only: the id is what lets one in).
Addresses addresses(const RunSettings& settings, const std::string& run_id);

}  // namespace corridor
