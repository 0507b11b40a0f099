// SPDX-License-Identifier: Apache-2.0
// One launcher a run: `train` and `resume` hold the run's lock as long as any of its processes
// lives.
#pragma once

#include <chrono>

#include "proto/run/run_directory.h"
#include "proto/system/descriptor.h"

namespace corridor::cluster {

// An flock on <run>/lock, which says who holds it, until the descriptor is closed. The child
// processes inherit it: the run of a launcher that was killed stays locked until the last of them
// has ended too. Throws Failure naming the owner when the run is going on. Where the owner is gone
// already, its processes get until `patience` is over to end.
[[nodiscard]] Descriptor lock_run(const RunDirectory& directory,
                                  std::chrono::milliseconds patience = std::chrono::seconds(10));

}  // namespace corridor::cluster
