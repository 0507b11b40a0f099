// SPDX-License-Identifier: Apache-2.0
// A manifest as `corridor train` writes it, of no machine.
#pragma once

#include "proto/config/config_values.h"
#include "proto/run/manifest.h"

namespace corridor::testing_support {

inline RunManifest some_manifest(const RunConfig& config) {
  return {"0123456789abcdef0123456789abcdef",
          config.run.seed,
          "/scenarios/fake.toml",
          "2026-01-02T03:04:05Z",
          "host",
          "cpu",
          2,
          {"0.1.0", "abc", "1.15.0", "1.13.0", "/blas", "GNU 12.2.0"},
          to_toml(config),
          {}};
}

}  // namespace corridor::testing_support
