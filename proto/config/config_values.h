// SPDX-License-Identifier: Apache-2.0
// RunConfigs as values: written, compared, put together. Pure.
#pragma once

#include <string>
#include <vector>

#include "proto/config/config_key.h"
#include "proto/settings/settings.h"

namespace corridor {

// What was trained as `trained` says, in the world that `world` describes: each key of set_by_world
// is `world`'s, all others are as trained. Throws Failure naming `name` where the two do not fit
// each other.
RunConfig in_world(const RunConfig& trained, const RunConfig& world, const std::string& name);

// The keys whose values differ, in the order of to_toml.
struct ChangedKey {
  std::string name;    // "mop.gamma"
  std::string before;  // as TOML
  std::string now;
  Heeds heeds;
};
std::vector<ChangedKey> changed_keys(const RunConfig& before, const RunConfig& now);

// The keys of which `holds` is true, for people: "[evaluation], run.host", a table where it is true
// of all of its keys.
std::string keys_where(bool (*holds)(Heeds));

// Every key with its value and comment; parsing it again gives an equal config (doubles print
// shortest round-trip).
std::string to_toml(const RunConfig& config);

}  // namespace corridor
