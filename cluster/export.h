// SPDX-License-Identifier: Apache-2.0
// `corridor export`: a run's networks and settings, without its replay, metrics and logs: small
// enough to keep with the sources, enough to evaluate and to train on from.
#pragma once

#include <filesystem>

namespace corridor::cluster {

// Creates `to`: a run directory with config.toml, networks.safetensors, and the run's manifest with
// its fingerprint. Throws Failure when the training of `run` is not complete, and when `to` is
// there already.
void export_run(const std::filesystem::path& run, const std::filesystem::path& to);

}  // namespace corridor::cluster
