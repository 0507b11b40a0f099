// SPDX-License-Identifier: Apache-2.0
#include "proto/run/run_directory.h"

#include "proto/base/failure.h"
#include "proto/base/text.h"
#include "proto/system/files.h"

namespace corridor {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFolders[] = {"sumo", "log", "metrics", "checkpoints", "evaluation/episodes"};

// Where there is nothing yet; an empty folder is nobody's.
const fs::path& unused(const fs::path& root) {
  std::error_code ignored;
  if (!fs::exists(fs::symlink_status(root, ignored)) || is_empty_folder(root)) return root;
  if (fs::exists(root / kManifestFile, ignored)) {
    throw Failure(
        "{} exists already: continue it with `corridor resume {}`, or choose another name",
        root.string(), shell_quoted(root.string()));
  }
  throw Failure("{} exists already and is no run, or one that never began: choose another name",
                root.string());
}

}  // namespace

std::string actor_name(int index) { return fmt::format("{}-{}", kActorName, index); }

RunDirectory RunDirectory::create(const fs::path& root) {
  RunDirectory directory(unused(root));
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

void RunDirectory::remove_empty_folders() const {
  std::error_code not_empty;
  for (const char* folder : kFolders) {
    for (fs::path path = folder; !path.empty(); path = path.parent_path()) {
      fs::remove(root_ / path, not_empty);
    }
  }
}

void RunDirectory::remove_leftovers() const {
  on_disk("remove leftovers from", root_, [&] {
    std::vector<fs::path> doomed;
    const auto look = [&](const auto& entry) {
      if (is_leftover(entry.path()) || entry.path().extension() == ".partial") {
        doomed.push_back(entry.path());
      }
    };
    for (const auto& entry : fs::directory_iterator(root_)) look(entry);
    for (const fs::path& folder : {network().parent_path(), root_ / "log", root_ / "metrics",
                                   checkpoints(), tensorboard()}) {
      if (!fs::is_directory(folder)) continue;
      for (const auto& entry : fs::recursive_directory_iterator(folder)) look(entry);
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

NewRun::NewRun(const fs::path& root)
    : folder_(unused(root)), directory_(RunDirectory::create(folder_.path())) {}

bool NewRun::publish() { return folder_.publish(kManifestFile); }

}  // namespace corridor
