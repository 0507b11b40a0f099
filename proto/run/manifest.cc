// SPDX-License-Identifier: Apache-2.0
#include "proto/run/manifest.h"

#include "proto/base/failure.h"
#include "proto/system/files.h"

namespace corridor {
namespace {

constexpr std::size_t kRunIdDigits = 32;

}  // namespace

void RunManifest::check() const {
  if (run_id.size() != kRunIdDigits ||
      run_id.find_first_not_of("0123456789abcdef") != std::string::npos) {
    throw Failure("run_id is not {} hex digits", kRunIdDigits);
  }
}

void write_manifest(const RunDirectory& directory, const RunManifest& manifest) {
  write_file(directory.manifest(), json_of<OrderedJson>(manifest).dump(2) + "\n");
}

RunManifest read_manifest(const RunDirectory& directory) {
  return parse_record<RunManifest>(read_json(directory.manifest()), directory.manifest().string(),
                                   "manifest of a run");
}

}  // namespace corridor
