#include "proto/run/run_directory.h"

#include "proto/base/failure.h"
#include "proto/base/json.h"
#include "proto/system/files.h"

namespace corridor {
namespace {

namespace fs = std::filesystem;

void create_folders(const fs::path& root) {
  for (const char* name : {"sumo", "log", "metrics", "checkpoints", "evaluation/episodes"}) {
    fs::create_directories(root / name);
  }
}

}  // namespace

std::string actor_name(int index) { return fmt::format("actor-{}", index); }

RunDirectory RunDirectory::create(const fs::path& root) {
  on_disk("create", root, [&] {
    if (fs::exists(root / "manifest.json")) {
      throw Failure("{} exists already: continue it with `corridor resume`, or choose another name",
                    root.string());
    }
    if (fs::exists(root)) {
      throw Failure(
          "{} exists already and is no run, or one that never began: remove it, or choose "
          "another name",
          root.string());
    }
    create_folders(root);
    for (const fs::path& made : {root, parent_of(root)}) sync_directory(made);
  });
  return RunDirectory(root);
}

RunDirectory RunDirectory::open(const fs::path& root) {
  RunDirectory directory(root);
  std::error_code ignored;
  for (const fs::path& file : {directory.config(), directory.manifest()}) {
    if (!fs::is_regular_file(file, ignored)) {
      throw Failure("{} is no run directory: {} is missing", root.string(),
                    file.filename().string());
    }
  }
  on_disk("create folders in", root, [&] { create_folders(root); });
  return directory;
}

void RunDirectory::remove_leftovers() const {
  on_disk("remove leftovers from", root_, [&] {
    std::vector<fs::path> doomed;
    for (const auto& entry : fs::recursive_directory_iterator(root_)) {
      if (is_leftover(entry.path()) || entry.path().extension() == ".partial") {
        doomed.push_back(entry.path());
      }
    }
    for (const fs::path& path : doomed) fs::remove_all(path);
  });
}

fs::path RunDirectory::log(std::string_view process) const {
  return root_ / "log" / (std::string(process) + ".log");
}

fs::path RunDirectory::metrics(std::string_view process) const {
  return root_ / "metrics" / (std::string(process) + ".jsonl");
}

RunManifest read_manifest(const RunDirectory& directory) {
  const Json manifest = read_json(directory.manifest());
  constexpr std::size_t kRunIdDigits = 32;
  std::string run_id;
  if (manifest.is_object() && manifest.contains("run_id") && manifest["run_id"].is_string()) {
    run_id = manifest["run_id"].get<std::string>();
  }
  if (run_id.size() != kRunIdDigits ||
      run_id.find_first_not_of("0123456789abcdef") != std::string::npos) {
    throw Failure("{} is damaged: run_id is not {} hex digits", directory.manifest().string(),
                  kRunIdDigits);
  }
  return {run_id};
}

}  // namespace corridor
