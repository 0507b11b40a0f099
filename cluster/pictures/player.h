// SPDX-License-Identifier: Apache-2.0
// Clips of driven episodes as one HTML page that plays them: needs no network. Pure.
#pragma once

#include <string>
#include <vector>

#include "cluster/pictures/clip.h"

namespace corridor::cluster {

std::string player_page(const std::vector<Clip>& clips);

}  // namespace corridor::cluster
