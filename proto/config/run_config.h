// SPDX-License-Identifier: Apache-2.0
// A scenario file (TOML) -> RunConfig. Every key is known, typed and range-checked; a file may
// name another with `base = "other.toml"` (relative to itself) and then says only what differs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "proto/base/json_fwd.h"
#include "proto/settings/settings.h"

namespace corridor {

// Reads a scenario and applies `overrides` ("table.key=value", value in TOML; a bare word is taken
// as a string) in order. Throws Failure naming file, key, value and what would be right: unknown
// key or table, wrong type, value out of range, a missing or unreadable file, a base that includes
// itself, settings that contradict each other (a road too short for an episode, an even number of
// corridors, a threshold for each lane missing ...).
RunConfig load_run_config(const std::filesystem::path& file,
                          const std::vector<std::string>& overrides = {});

// The same from text; `name` stands in messages. `base` is refused here.
RunConfig parse_run_config(const std::string& text, const std::string& name,
                           const std::vector<std::string>& overrides = {});

// `config` with overrides; throws likewise.
RunConfig with_overrides(const RunConfig& config, const std::string& name,
                         const std::vector<std::string>& overrides);

// Any TOML file as JSON, for files that are no scenarios; dates and times are refused. Throws
// Failure naming the file when it is missing or no TOML.
Json load_toml(const std::filesystem::path& file);

}  // namespace corridor
