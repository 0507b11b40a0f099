// SPDX-License-Identifier: Apache-2.0
// The checkpoints of a run: what it is at the end of a round, whole on disk or not there at all.
//
//   checkpoints/<round>/manifest.json          round; size and XXH3 of every other file
//                       learner.safetensors    the learner's state
//                       replay.safetensors     the replay's, but for its rows
//                       rows-<first>-<end>     the replay's rows with the keys [first, end)
//
// A checkpoint is filled under another name and gets its own by a rename when everything is on
// disk: so a directory named by a number was whole once, and the largest number is the newest. Rows
// never change: a checkpoint writes those that came since the one before and links to the others,
// so that each directory holds everything that it needs and an old one can be removed at any time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "proto/run/run_directory.h"
#include "proto/run/tensor_file.h"

namespace corridor {

inline constexpr const char* kLearnerFile = "learner.safetensors";
inline constexpr const char* kReplayFile = "replay.safetensors";
// Tensors that the replay writes and that a fingerprint needs.
inline constexpr const char* kRowsTensor = "rows";         // of a file of rows
inline constexpr const char* kLeavesTensor = "leaves";     // of kReplayFile: one a row held
inline constexpr const char* kNextKeyTensor = "next_key";  // of kReplayFile: behind the newest row

class Checkpoints {
 public:
  // `directory`: RunDirectory::checkpoints().
  explicit Checkpoints(std::filesystem::path directory) : directory_(std::move(directory)) {}

  // An empty directory to fill; what an earlier attempt left there is removed.
  std::filesystem::path begin(std::uint64_t round) const;
  // Writes the manifest, gives the directory its name, and removes all other checkpoints but the
  // newest `kept` - 1 of earlier rounds. Later rounds are of a continuation that was given up.
  void commit(std::uint64_t round, int kept) const;

  // The newest one's directory, unread; nothing when there is none.
  std::optional<std::filesystem::path> newest() const;

  // Reads all of the newest one; where something in it is missing or not as its manifest says, the
  // one before, and so on. Those newer than the first whole one are renamed to <round>.damaged.
  // Returns a line for each of them. Throws Failure, and renames nothing, when there are
  // checkpoints but no whole one. Nobody else may be using them (cluster/launch/run_lock.h).
  std::vector<std::string> set_aside_damaged() const;

  // Throws Failure naming the damaged file.
  static void check(const std::filesystem::path& checkpoint);

 private:
  std::filesystem::path directory_;
};

// checkpoints/<round> -> round.
std::uint64_t checkpoint_round(const std::filesystem::path& checkpoint);
// Rounds 0 .. n-1 are in the newest one; 0 when there is none yet.
std::uint64_t rounds_done(const RunDirectory& directory);

// One file of a checkpoint, checked against the manifest. Throws Failure naming it when it is
// missing or damaged.
TensorFile read_checkpoint_file(const std::filesystem::path& checkpoint, const std::string& name);

// A file of rows: kRowsTensor [end_key - first_key, stride].
struct RowsFile {
  std::uint64_t first_key = 0;
  std::uint64_t end_key = 0;
  std::string name() const;
  bool operator==(const RowsFile&) const = default;
};
// A checkpoint's, ascending. Throws Failure when they do not follow each other.
std::vector<RowsFile> rows_files(const std::filesystem::path& checkpoint);

}  // namespace corridor
