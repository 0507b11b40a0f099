// A run directory in the making: a run that never began leaves nothing.
#pragma once

#include <filesystem>
#include <string>

#include "proto/run/manifest.h"
#include "proto/run/run_directory.h"
#include "proto/settings/settings.h"

namespace corridor::cluster {

class NewRun {
 public:
  // Throws Failure when `root` is there already.
  explicit NewRun(const std::filesystem::path& root) : directory_(RunDirectory::create(root)) {}
  // Removes the directory unless it is kept.
  ~NewRun();
  NewRun(const NewRun&) = delete;
  NewRun& operator=(const NewRun&) = delete;

  const RunDirectory& directory() const { return directory_; }
  // What processes read: SUMO's files, config.toml, and last, since with it the directory is a run,
  // manifest.json. All of it survives a power failure.
  void fill(const RunConfig& config, const std::string& config_toml,
            const RunManifest& manifest) const;
  void keep() { kept_ = true; }

 private:
  RunDirectory directory_;
  bool kept_ = false;
};

}  // namespace corridor::cluster
