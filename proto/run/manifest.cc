// SPDX-License-Identifier: Apache-2.0
#include "proto/run/manifest.h"

#include <type_traits>
#include <utility>

#include "proto/base/failure.h"
#include "proto/base/text.h"
#include "proto/system/files.h"

namespace corridor {
namespace {

constexpr std::size_t kRunIdDigits = 32;

}  // namespace

std::vector<ChangedVersion> changed_versions(const RunVersions& before, const RunVersions& now) {
  std::vector<ChangedVersion> changed;
  const auto compare = [&](const char* name, const auto& was, const auto& is) {
    if constexpr (std::is_same_v<std::decay_t<decltype(was)>, std::string>) {
      if (was != is) changed.push_back({name, was, is});
    } else if (was && is && *was != *is) {
      changed.push_back({name, *was, *is});
    }
  };
  compare("corridor", before.corridor, now.corridor);
  compare("sumo", before.sumo, now.sumo);
  compare("libtorch", before.libtorch, now.libtorch);
  compare("blas", before.blas, now.blas);
  compare("blas_core", before.blas_core, now.blas_core);
  compare("blas_config", before.blas_config, now.blas_config);
  compare("compiler", before.compiler, now.compiler);
  return changed;
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
          "on "
          "all the same, and the manifest says so",
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
