// SPDX-License-Identifier: Apache-2.0
// Fingerprints of trainings, on record by what their bits may depend on: SUMO's traffic, and
// OpenBLAS with its kernels. On the CPU a learner computes without LibTorch. Debian 12's learner
// and replay server give Debian 13's bits beside Debian 13's actor (docs/operations.md): compiler,
// C library and OpenBLAS do not matter to them.
#pragma once

#include <filesystem>
#include <optional>
#include <sstream>
#include <string>

#include "proto/run/manifest.h"
#include "proto/run/run_directory.h"

namespace corridor::testing_support {

struct Libraries {
  std::string sumo;     // "1.15.0"
  std::string blas;     // "OpenBLAS 0.3.21"
  std::string kernels;  // "Haswell"

  bool operator==(const Libraries&) const = default;
};

// Those that a run was trained with.
inline Libraries libraries_of(const std::filesystem::path& run) {
  const RunVersions versions = read_manifest(RunDirectory::open(run)).versions;
  std::istringstream config(versions.blas_config.value_or(""));
  std::string name;
  std::string version;
  config >> name >> version;
  return {versions.sumo, name + ' ' + version, versions.blas_core.value_or("")};
}

// What the training of e2e/run_support.h comes to. Who changes what a training computes changes
// these, and nobody else.
inline std::optional<std::string> golden_fingerprint(const Libraries& libraries) {
  const struct {
    Libraries libraries;
    const char* fingerprint;
  } kOnRecord[] = {
      {{"1.15.0", "OpenBLAS 0.3.21", "Haswell"}, "caf0e003bbc79f39"},  // Debian 12
      {{"1.18.0", "OpenBLAS 0.3.29", "Haswell"}, "3473357b49beec8a"},  // Debian 13
  };
  for (const auto& record : kOnRecord) {
    if (record.libraries == libraries) return record.fingerprint;
  }
  return {};
}

// For a test that has nothing to compare `fingerprint` with.
inline std::string no_record(const Libraries& libraries, const std::string& fingerprint) {
  return "no fingerprint on record for SUMO " + libraries.sumo + ", " + libraries.blas +
         " with kernels for " + libraries.kernels + ": got " + fingerprint;
}

}  // namespace corridor::testing_support
