// SPDX-License-Identifier: Apache-2.0
// How files get to disk whole and back: atomic writes, syncs, and errors that name the path.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "proto/base/failure.h"
#include "proto/base/json_fwd.h"

namespace corridor {

// Writes beside the target, syncs and renames: readers see the old file or the new one, whole.
// Throws Failure (disk full, read-only ...) with the path and the system's reason; the old file is
// then untouched and nothing is left beside it.
void write_file(const std::filesystem::path& file, std::string_view content);
// Throws Failure when missing or unreadable.
std::string read_file(const std::filesystem::path& file);
// Throws Failure naming the file when missing or not JSON.
Json read_json(const std::filesystem::path& file);
// Creates the folder with its parents where they are missing, and these in it. Throws Failure.
void create_folders(const std::filesystem::path& folder,
                    std::span<const char* const> children = {});
// Makes what another program wrote survive a power failure.
void sync_file(const std::filesystem::path& file);
// Makes a rename or a new name in the directory survive one.
void sync_directory(const std::filesystem::path& directory);
// Turns the standard library's error into a Failure: "cannot <what> <path>: <reason>".
template <typename Action>
void on_disk(const char* what, const std::filesystem::path& path, const Action& action) {
  try {
    action();
  } catch (const std::filesystem::filesystem_error& error) {
    throw Failure("cannot {} {}: {}", what, path.string(), error.code().message());
  }
}

// A folder that goes, with all in it, unless what is made there is kept.
class FolderInTheMaking {
 public:
  explicit FolderInTheMaking(std::filesystem::path folder) : folder_(std::move(folder)) {}
  ~FolderInTheMaking();
  FolderInTheMaking(const FolderInTheMaking&) = delete;
  FolderInTheMaking& operator=(const FolderInTheMaking&) = delete;
  void keep() { folder_.clear(); }

 private:
  std::filesystem::path folder_;
};

// The folder that a file lies in: "." for a bare name.
std::filesystem::path parent_of(const std::filesystem::path& file);

// What write_file and others leave behind when they are killed: such names are nobody's.
bool is_leftover(const std::filesystem::path& file);

}  // namespace corridor
