// SPDX-License-Identifier: Apache-2.0
// Whether a scenario's settings fit each other; each is in its own range already
// (proto/config/config_keys.h). Private to proto/. Pure.
#pragma once

#include <string>

#include "proto/settings/settings.h"

namespace corridor {

// Throws Failure naming `name`, the keys that contradict each other, and what would be right.
void check_config(const RunConfig& config, const std::string& name);

}  // namespace corridor
