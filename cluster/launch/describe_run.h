// SPDX-License-Identifier: Apache-2.0
// What this machine puts into a run's manifest (proto/run/manifest.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "proto/run/manifest.h"
#include "proto/run/run_directory.h"
#include "proto/settings/settings.h"

namespace corridor::cluster {

// 32 hex digits from the system's generator: who knows them belongs to the run.
std::string draw_run_id();

// What is installed here, but for what the learner alone knows. Asks netconvert.
RunVersions versions_here();

// Of a run that begins now, here.
RunManifest describe_run(const std::string& run_id, std::uint64_t seed,
                         const std::filesystem::path& scenario, const std::string& config_toml,
                         const RunVersions& versions);

// The settings that the manifest holds the run to, whatever its config.toml says now. Throws
// Failure.
RunConfig config_at_start(const RunDirectory& directory);

}  // namespace corridor::cluster
