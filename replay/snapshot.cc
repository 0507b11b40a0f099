// SPDX-License-Identifier: Apache-2.0
#include "replay/snapshot.h"

#include "proto/base/failure.h"
#include "proto/run/run_directory.h"
#include "proto/system/files.h"

namespace corridor::replay {
namespace {

namespace fs = std::filesystem;

// Some file systems have no links.
void link_or_copy(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::create_hard_link(from, to, error);
  if (!error) return;
  on_disk("copy to", to, [&] { write_file(to, read_file(from)); });
}

}  // namespace

void write(const Snapshot& snapshot, const fs::path& directory, const fs::path& previous) {
  for (const RowsFile& file : snapshot.files) {
    link_or_copy(previous / file.name(), directory / file.name());
  }
  if (!snapshot.rows.empty()) {
    const std::size_t count = snapshot.rows.size() / snapshot.stride;
    TensorFile file;
    file.tensors.emplace(kRowsTensor, Tensor{{count, snapshot.stride}, snapshot.rows});
    const RowsFile place{snapshot.first_new_key, snapshot.first_new_key + count};
    write_tensors(directory / place.name(), file);
  }
  write_tensors(directory / kReplayFile, snapshot.head);
}

}  // namespace corridor::replay
