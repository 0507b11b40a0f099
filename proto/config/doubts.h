// SPDX-License-Identifier: Apache-2.0
// What makes no sense in a scenario, though it can be run. Pure.
#pragma once

#include <string>
#include <vector>

#include "proto/settings/settings.h"

namespace corridor {

// A line for people each, naming the keys: nothing would be learned, what is asked for never comes.
std::vector<std::string> doubts_about(const RunConfig& config);

}  // namespace corridor
