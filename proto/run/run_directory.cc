// SPDX-License-Identifier: Apache-2.0
#include "proto/run/run_directory.h"

#include "proto/base/failure.h"
#include "proto/system/files.h"

namespace corridor {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFolders[] = {"sumo", "log", "metrics", "checkpoints", "evaluation/episodes"};

}  // namespace

std::string actor_name(int index) { return fmt::format("{}-{}", kActorName, index); }

RunDirectory RunDirectory::create(const fs::path& root) {
  RunDirectory directory(root);
  std::error_code ignored;
  if (fs::exists(directory.manifest(), ignored)) {
    throw Failure("{} exists already: continue it with `corridor resume`, or choose another name",
                  root.string());
  }
  if (fs::exists(root, ignored)) {
    throw Failure(
        "{} exists already and is no run, or one that never began: remove it, or choose "
        "another name",
        root.string());
  }
  directory.create_folders();
  for (const fs::path& made : {root, parent_of(root)}) sync_directory(made);
  return directory;
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
  return directory;
}

void RunDirectory::create_folders() const { corridor::create_folders(root_, kFolders); }

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

fs::path RunDirectory::evaluation(const EvaluationName& name) const {
  return evaluation() / (name.text() + ".json");
}

fs::path RunDirectory::episode(const EpisodeName& name) const {
  return episodes() / (name.text() + ".json");
}

fs::path RunDirectory::hindsight(const EvaluationName& name) const {
  return hindsight() / (name.text() + ".json");
}

}  // namespace corridor
