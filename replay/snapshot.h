// SPDX-License-Identifier: Apache-2.0
// The replay's part of a checkpoint (proto/run/checkpoints.h).
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "proto/run/checkpoints.h"
#include "proto/run/tensor_file.h"

namespace corridor::replay {

// What the replay is between two blocks, as a value of its own, but for rows that are on disk
// already.
struct Snapshot {
  TensorFile head;                  // kReplayFile
  std::vector<RowsFile> files;      // of an earlier checkpoint, ascending
  std::uint64_t first_new_key = 0;  // what follows them
  std::vector<float> rows;          // from first_new_key on: [row, stride]; may be none
  std::size_t stride = 0;
};

// Links the files, which `previous` has, and writes the rest: on disk when it returns. Throws
// Failure.
void write(const Snapshot& snapshot, const std::filesystem::path& directory,
           const std::filesystem::path& previous);

}  // namespace corridor::replay
