// SPDX-License-Identifier: Apache-2.0
#include "proto/run/manifest.h"

#include <utility>

#include "proto/base/failure.h"
#include "proto/base/text.h"
#include "proto/system/files.h"

namespace corridor {
namespace {

constexpr std::size_t kRunIdDigits = 32;

}  // namespace

std::vector<ChangedVersion> changed_versions(const RunVersions& before, const RunVersions& now) {
  const auto members_of = [](const RunVersions& versions) {
    std::vector<std::pair<std::string, std::optional<std::string>>> members;
    RunVersions::fields(versions, [&](const char* name, const auto& value, auto...) {
      if (static_cast<const void*>(&value) != &versions.git_commit)
        members.emplace_back(name, value);
    });
    return members;
  };
  const auto were = members_of(before), are = members_of(now);
  std::vector<ChangedVersion> changed;
  for (std::size_t i = 0; i < were.size(); ++i) {
    const auto& [name, was] = were[i];
    const auto& is = are[i].second;
    if (was && is && *was != *is) changed.push_back({name, *was, *is});
  }
  return changed;
}

void RunManifest::go_on(const Continuation& continuation) {
  if (!continuations) continuations.emplace();
  continuations->push_back(continuation);
}

const RunVersions& RunManifest::versions_now() const {
  return continuations && !continuations->empty() ? continuations->back().versions : versions;
}
RunVersions& RunManifest::versions_now() {
  return const_cast<RunVersions&>(std::as_const(*this).versions_now());
}

std::vector<std::string> allowed_changes(const std::vector<ChangedVersion>& changed, bool allowed) {
  std::vector<std::string> lines;
  for (const auto& [name, before, now] : changed) {
    if (!allowed) {
      throw Failure(
          "this run was trained with {} {}, and here is {}: its bits would become others; {} goes "
          "on all the same, and the manifest says so",
          name, before, now, kAllowOtherBits);
    }
    lines.push_back(fmt::format("{} {}, where it was {}", name, now, before));
  }
  return lines;
}

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

std::filesystem::path results_folder(const RunDirectory& run) {
  const RunManifest manifest = read_manifest(run);
  if (!manifest.fingerprint || manifest.trained) return run.root();
  return std::filesystem::path("evaluated") / std::filesystem::canonical(run.root()).filename();
}

RunDirectory open_results(const std::filesystem::path& run) {
  const std::filesystem::path folder = results_folder(RunDirectory::open(run));
  if (std::filesystem::exists(folder)) return RunDirectory::open(folder);
  throw Failure("{} has networks only, and nothing is in {} yet: corridor evaluate {}",
                run.string(), folder.string(), shell_quoted(run.string()));
}

}  // namespace corridor
