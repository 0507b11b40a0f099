// SPDX-License-Identifier: Apache-2.0
// The networks of a run, as they drive: their files.
#pragma once

#include <optional>

#include "proto/run/run_directory.h"
#include "proto/settings/named_networks.h"
#include "proto/settings/settings.h"

namespace corridor {

// networks.safetensors, a tensor a network by its name: those that a training began with, or that a
// run without checkpoints drives with; nothing when there is no such file. Throws Failure naming
// the file when it is damaged or its networks are not of the size that `config` asks for.
std::optional<Networks> given_networks(const RunDirectory& directory, const RunConfig& config);
void write_networks(const RunDirectory& directory, const Networks& networks);

// Of the newest checkpoint: the best so far; without one, given_networks(). Throws Failure
// likewise.
std::optional<Networks> newest_networks(const RunDirectory& directory, const RunConfig& config);

}  // namespace corridor
