// SPDX-License-Identifier: Apache-2.0
#include "proto/run/checkpoints.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <utility>

#include "proto/base/failure.h"
#include "proto/base/hash.h"
#include "proto/base/json.h"
#include "proto/base/text.h"
#include "proto/system/files.h"
#include "proto/system/pulse.h"

namespace corridor {
namespace {

namespace fs = std::filesystem;

constexpr const char* kManifest = "manifest.json";
// Follow a round's number in the names of what is no checkpoint yet, or no more.
constexpr const char* kPartial = ".partial";
constexpr const char* kDamaged = ".damaged";

std::optional<std::uint64_t> round_of(const fs::path& path) {
  return parse_number<std::uint64_t>(path.filename().string());
}

// Ascending.
std::vector<std::uint64_t> rounds_in(const fs::path& directory) {
  std::vector<std::uint64_t> rounds;
  if (!fs::exists(directory)) return rounds;  // an exported run has none
  for (const auto& entry : fs::directory_iterator(directory)) {
    const auto round = round_of(entry.path());
    if (round && entry.is_directory()) rounds.push_back(*round);
  }
  std::sort(rounds.begin(), rounds.end());
  return rounds;
}

// "files" of a manifest.
Json files_of(const fs::path& checkpoint) {
  const fs::path file = checkpoint / kManifest;
  try {
    const Json manifest = read_json(file);
    if (whole_number<std::uint64_t>(manifest.at("round")) != checkpoint_round(checkpoint)) {
      throw Failure("it is of another round");
    }
    for (const auto& [name, expected] : manifest.at("files").items()) {
      whole_number<std::uint64_t>(expected.at("size"));
      if (!expected.at("xxh3").is_string()) throw Failure("{} has no hash", name);
    }
    return manifest.at("files");
  } catch (const std::exception& error) {
    throw Failure("{} is damaged: {}", file.string(), error.what());
  }
}

std::string read_checked(const fs::path& file, const Json& expected) {
  const auto size = expected.at("size").get<std::uint64_t>();
  std::error_code error;
  // What is of another size is not read: it may be of any size.
  std::string content;
  if (fs::file_size(file, error) == size || error) content = read_file(file);
  if (content.size() != size || hash_of(content) != expected.at("xxh3").get<std::string>()) {
    throw Failure("{} is damaged: its size or hash is not what the manifest beside it says",
                  file.string());
  }
  return content;
}

}  // namespace

fs::path Checkpoints::begin(std::uint64_t round) const {
  fs::path partial = directory_ / (std::to_string(round) + kPartial);
  on_disk("create", partial, [&] {
    fs::remove_all(partial);
    fs::create_directories(partial);
  });
  return partial;
}

void Checkpoints::commit(std::uint64_t round, int kept) const {
  const fs::path partial = directory_ / (std::to_string(round) + kPartial);
  const fs::path whole = directory_ / std::to_string(round);
  on_disk("complete checkpoint", partial, [&] {
    // Files that the newest checkpoint has too need not be read again.
    const std::optional<fs::path> before = newest();
    const Json known = before ? files_of(*before) : Json::object();
    Json files = Json::object();
    for (const auto& entry : fs::directory_iterator(partial)) {
      const std::string name = entry.path().filename().string();
      if (known.contains(name) && fs::equivalent(entry.path(), *before / name)) {
        files[name] = known.at(name);
        continue;
      }
      const std::string content = read_file(entry.path());
      files[name] = {{"size", content.size()}, {"xxh3", hash_of(content)}};
    }
    write_file(partial / kManifest, Json{{"round", round}, {"files", files}}.dump(2) + "\n");
    // One that is there already is of a continuation that was given up.
    fs::remove_all(whole);
    fs::rename(partial, whole);
    sync_directory(directory_);

    std::vector<std::uint64_t> stay = rounds_in(directory_);
    std::erase_if(stay, [&](std::uint64_t found) { return found > round; });
    const auto most = std::max<std::ptrdiff_t>(kept, 1);
    if (std::ssize(stay) > most) stay.erase(stay.begin(), stay.end() - most);
    std::vector<fs::path> doomed;
    for (const auto& entry : fs::directory_iterator(directory_)) {
      const auto found = round_of(entry.path());
      // What people put beside them stays.
      const bool ours =
          found || (round_of(entry.path().stem()) &&
                    (entry.path().extension() == kPartial || entry.path().extension() == kDamaged));
      if (ours && !(found && std::ranges::binary_search(stay, *found))) {
        doomed.push_back(entry.path());
      }
    }
    for (const fs::path& path : doomed) fs::remove_all(path);
  });
}

std::optional<fs::path> Checkpoints::newest() const {
  std::optional<fs::path> result;
  on_disk("read", directory_, [&] {
    const std::vector<std::uint64_t> rounds = rounds_in(directory_);
    if (!rounds.empty()) result = directory_ / std::to_string(rounds.back());
  });
  return result;
}

void Checkpoints::check(const fs::path& checkpoint) {
  const Json files = files_of(checkpoint);
  for (const auto& [name, expected] : files.items()) {
    read_checked(checkpoint / name, expected);
  }
}

std::vector<std::string> Checkpoints::set_aside_damaged() const {
  std::vector<std::string> lines;
  on_disk("set aside", directory_, [&] {
    std::vector<fs::path> damaged;
    const std::vector<std::uint64_t> rounds = rounds_in(directory_);
    for (auto round = rounds.rbegin(); round != rounds.rend(); ++round) {
      const fs::path checkpoint = directory_ / std::to_string(*round);
      try {
        check(checkpoint);
        break;
      } catch (const Failure& failure) {
        lines.emplace_back(failure.what());
        damaged.push_back(checkpoint);
      }
    }
    if (!damaged.empty() && damaged.size() == rounds.size()) {
      throw Failure("no checkpoint in {} is whole: {}; start the training anew",
                    directory_.string(), lines.front());
    }
    for (const fs::path& checkpoint : damaged) {
      const fs::path aside = checkpoint.string() + kDamaged;
      fs::remove_all(aside);
      fs::rename(checkpoint, aside);
    }
  });
  return lines;
}

std::uint64_t checkpoint_round(const fs::path& checkpoint) {
  const auto round = round_of(checkpoint);
  CORRIDOR_CHECK(round, "{} is no checkpoint", checkpoint.string());
  return *round;
}

std::uint64_t rounds_done(const RunDirectory& directory) {
  const auto newest = Checkpoints(directory.checkpoints()).newest();
  return newest ? checkpoint_round(*newest) + 1 : 0;
}

TensorFile read_checkpoint_file(const fs::path& checkpoint, const std::string& name) {
  beat();  // of many files, one after the other
  const Json files = files_of(checkpoint);
  const fs::path file = checkpoint / name;
  if (!files.contains(name)) {
    throw Failure("{} is damaged: it names no {}", (checkpoint / kManifest).string(), name);
  }
  return parse_tensors(read_checked(file, files.at(name)), file.string());
}

std::string RowsFile::name() const { return fmt::format("rows-{}-{}", first_key, end_key); }

std::vector<RowsFile> rows_files(const fs::path& checkpoint) {
  std::vector<RowsFile> files;
  on_disk("read", checkpoint, [&] {
    for (const auto& entry : fs::directory_iterator(checkpoint)) {
      const std::string name = entry.path().filename().string();
      RowsFile file;
      if (std::sscanf(name.c_str(), "rows-%" SCNu64 "-%" SCNu64, &file.first_key, &file.end_key) ==
              2 &&
          file.name() == name) {
        files.push_back(file);
      }
    }
  });
  std::sort(files.begin(), files.end(),
            [](const RowsFile& a, const RowsFile& b) { return a.first_key < b.first_key; });
  for (std::size_t i = 0; i < files.size(); ++i) {
    const bool follows = i == 0 || files[i].first_key == files[i - 1].end_key;
    if (!follows || files[i].first_key >= files[i].end_key) {
      throw Failure("{} is damaged: rows before {} are missing", checkpoint.string(),
                    files[i].name());
    }
  }
  return files;
}

}  // namespace corridor
