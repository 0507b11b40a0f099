// SPDX-License-Identifier: Apache-2.0
// A scenario's files for SUMO: the road and the vehicle types. They are plain SUMO files that its
// own tools open (`sumo-gui road.sumocfg`).
//
// The road is one straight edge with lanes 0 (right) to n-1, on which runs one route. Their names
// and those of the vehicle types are in proto/settings/sumo_names.h.
#pragma once

#include <chrono>
#include <filesystem>

#include "proto/settings/settings.h"

namespace corridor::scenarios {

// Writes road.nod.xml, road.edg.xml, traffic.rou.xml and road.sumocfg into `directory` (created
// when missing), and has `netconvert` make road.net.xml from the first two. netconvert is looked
// for in $SUMO_HOME/bin, then in PATH. All of it survives a power failure. Throws Failure when it
// is not there, refuses its input (with the first line of its complaint), or has not ended by the
// deadline (it is killed then).
void write_sumo_files(const RunConfig& config, const std::filesystem::path& directory,
                      std::chrono::milliseconds netconvert_deadline = std::chrono::seconds(60));

}  // namespace corridor::scenarios
