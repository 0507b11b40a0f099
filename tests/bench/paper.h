// SPDX-License-Identifier: Apache-2.0
// The scenario that benchmarks are about.
#pragma once

#include <string>

#include "proto/config/run_config.h"

namespace corridor::bench {

inline const RunConfig& paper() {
  static const RunConfig config =
      load_run_config(std::string(CORRIDOR_SOURCE_DIR) + "/scenarios/paper.toml");
  return config;
}

}  // namespace corridor::bench
