// SPDX-License-Identifier: Apache-2.0
// Whether two runs came to the same.
#pragma once

#include <filesystem>
#include <string>

#include "proto/run/checkpoints.h"

namespace corridor {

// Hash, in hex, over what a checkpoint holds: both networks, the optimiser's state, the replay's
// rows and priorities. Of every tensor its name, type, shape and values count, and the metadata;
// file names, times and the files' layout do not.
std::string fingerprint(const TensorFile& learner, const TensorFile& replay);
std::string fingerprint(const std::filesystem::path& checkpoint);

}  // namespace corridor
