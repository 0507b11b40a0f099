#include "proto/run/manifest.h"

#include "proto/base/failure.h"
#include "proto/run/json_record.h"
#include "proto/system/files.h"

namespace corridor {
namespace {

constexpr std::size_t kRunIdDigits = 32;
constexpr const char* kFingerprint = "fingerprint";

}  // namespace

void RunManifest::check() const {
  if (run_id.size() != kRunIdDigits ||
      run_id.find_first_not_of("0123456789abcdef") != std::string::npos) {
    throw Failure("run_id is not {} hex digits", kRunIdDigits);
  }
}

OrderedJson to_json(const RunManifest& manifest) {
  OrderedJson json = json_of<OrderedJson>(manifest);
  if (manifest.fingerprint) json[kFingerprint] = *manifest.fingerprint;
  return json;
}

void write_manifest(const RunDirectory& directory, const RunManifest& manifest) {
  const std::string text = to_json(manifest).dump(2) + "\n";
  write_file(directory.manifest(), text);
}

RunManifest read_manifest(const RunDirectory& directory) {
  const std::string file = directory.manifest().string();
  const Json json = read_json(directory.manifest());
  auto manifest = parse_record<RunManifest>(json, file, "manifest of a run");
  if (json.contains(kFingerprint)) read_value(json.at(kFingerprint), manifest.fingerprint);
  return manifest;
}

}  // namespace corridor
