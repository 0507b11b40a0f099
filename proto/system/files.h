// SPDX-License-Identifier: Apache-2.0
// How files get to disk whole and back: atomic writes, syncs, and errors that name the path.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "proto/base/failure.h"
#include "proto/base/json_fwd.h"
#include "proto/system/descriptor.h"

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

// A folder that gets its name when it is whole: of several processes that make one, one comes
// first, and nobody sees it half filled.
class NewFolder {
 public:
  // Creates an empty folder to fill, beside `target`, or in it where that is an empty folder
  // already. Throws Failure.
  explicit NewFolder(const std::filesystem::path& target);
  // What has not been published goes, with all in it.
  ~NewFolder();
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  // Gives it its name. False when something else has that name by now, which is left as it is. In a
  // folder that was there already, `last` is the file that comes there last. Throws Failure.
  bool publish(const std::filesystem::path& last = {});

 private:
  std::filesystem::path target_;
  std::filesystem::path path_;
  bool in_target_ = false;
};

// Before the work: throws Failure when nothing could be written into the folder, or it is missing
// and could not be made.
void check_folder_for_results(const std::filesystem::path& folder);

// Whether it is there and has nothing in it.
bool is_empty_folder(const std::filesystem::path& path);

// Where a user wants a result: a file, which is replaced whole, also where a symbolic link leads to
// it; a pipe or device, which is written to as it is; or "-", standard output.
class OutputFile {
 public:
  // Before the work: throws Failure when it could not be written to.
  explicit OutputFile(std::filesystem::path file);
  bool is_standard_output() const { return file_ == "-"; }
  // Waits for a pipe's reader. Throws Failure, and Stopped when a signal ends the wait.
  void write(std::string_view content) const;

 private:
  std::filesystem::path file_;
  bool through_ = false;  // not to be replaced
};

// A file without a name, in the system's folder for temporary files: gone with the object, however
// this process ends.
class UnnamedFile {
 public:
  UnnamedFile();
  // At its end. Throws Failure when the disk is full.
  void append(std::string_view content);
  std::string content() const;
  // In this process, and in programs that it starts while the object lives.
  std::filesystem::path path() const;

 private:
  Descriptor descriptor_;
};

// Another name for a folder, in which no option parser finds a character that means something to it
// (SUMO's reads , and : and ${} in paths). In this process, while the object lives.
class PlainlyNamedFolder {
 public:
  // Throws Failure when there is no such folder.
  explicit PlainlyNamedFolder(const std::filesystem::path& folder);
  std::filesystem::path path() const;

 private:
  Descriptor descriptor_;
};

// The folder that a file lies in: "." for a bare name.
std::filesystem::path parent_of(const std::filesystem::path& file);

// What write_file and others leave behind when they are killed: such names are nobody's.
bool is_leftover(const std::filesystem::path& file);

}  // namespace corridor
