// SPDX-License-Identifier: Apache-2.0
// A run directory as `corridor train` makes it, before anything was trained.
#pragma once

#include <filesystem>

#include "proto/config/config_values.h"
#include "proto/run/run_directory.h"
#include "proto/system/files.h"
#include "tests/support/some_manifest.h"

namespace corridor::testing_support {

inline RunDirectory untrained_run(const std::filesystem::path& root, const RunConfig& config = {}) {
  const RunDirectory directory = RunDirectory::create(root);
  write_file(directory.config(), to_toml(config));
  write_manifest(directory, some_manifest(config));
  return directory;
}

}  // namespace corridor::testing_support
