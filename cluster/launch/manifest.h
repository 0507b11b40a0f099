// manifest.json of a run: what made it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "proto/base/json_fwd.h"
#include "proto/run/run_directory.h"
#include "proto/settings/settings.h"

namespace corridor::cluster {

// 32 hex digits from the system's generator: who knows them belongs to the run.
std::string draw_run_id();

// run_id, seed, scenario, started (UTC), host, cpu, cores, and the versions of corridor, its git
// commit, SUMO, LibTorch, BLAS and compiler, and the settings (config, in TOML). What is not known
// says "unknown".
OrderedJson describe_run(const std::string& run_id, std::uint64_t seed,
                         const std::filesystem::path& scenario, const std::string& config_toml);

// The name of the scenario's file, "paper". Throws Failure when the manifest does not say.
std::string scenario_name(const RunDirectory& directory);

// The settings with which the run began, whatever its config.toml says now. Throws Failure.
RunConfig config_at_start(const RunDirectory& directory);

}  // namespace corridor::cluster
