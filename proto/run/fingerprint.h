// What a run's newest checkpoint says.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "proto/run/run_directory.h"
#include "proto/run/tensor_file.h"

namespace corridor {

struct Checkpoint {
  std::filesystem::path directory;
  std::uint64_t rounds_done = 0;  // rounds 0 .. rounds_done-1 are in it
};

// Nothing when there is none yet.
std::optional<Checkpoint> newest_checkpoint(const RunDirectory& directory);
// In it; 0 when there is none yet.
std::uint64_t rounds_done(const RunDirectory& directory);

// Hash, in hex, over what a checkpoint holds: both networks, the optimiser's state, the replay's
// rows and priorities. Of every tensor its name, type, shape and values count, and the metadata;
// file names, times and the files' layout do not.
std::string fingerprint(const TensorFile& learner, const TensorFile& replay);
std::string fingerprint(const Checkpoint& checkpoint);

}  // namespace corridor
