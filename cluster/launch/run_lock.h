// SPDX-License-Identifier: Apache-2.0
// One launcher a run or experiment: `train`, `resume` and `experiment` hold the folder's lock as
// long as any of their processes lives.
#pragma once

#include <chrono>
#include <filesystem>

#include "proto/system/descriptor.h"

namespace corridor::cluster {

// An flock on <folder>/lock, which says who holds it, until the descriptor is closed. The child
// processes inherit it: the run of a launcher that was killed stays locked until the last of them
// has ended too. Throws Failure naming the owner when the run is going on. Where the owner is gone
// already, its processes get until `patience` is over to end.
[[nodiscard]] Descriptor lock_folder(const std::filesystem::path& folder,
                                     std::chrono::milliseconds patience = std::chrono::seconds(10));

}  // namespace corridor::cluster
