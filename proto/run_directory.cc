#include "proto/run_directory.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <nlohmann/json.hpp>

#include "proto/failure.h"
#include "proto/hash.h"
#include "proto/json_numbers.h"
#include "proto/settings.h"

namespace corridor {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// errno's text. The POSIX calls here, unlike streams, say what went wrong.
std::string reason() { return std::strerror(errno); }

// A file descriptor that is closed.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int get() const { return fd_; }
  bool valid() const { return fd_ >= 0; }
  // Whether closing reported no error (a network file system tells of a full disk only here).
  bool close() {
    const int fd = std::exchange(fd_, -1);
    return fd < 0 || ::close(fd) == 0;
  }

 private:
  int fd_;
};

bool write_all(int fd, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(fd, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

// Makes a rename or a new file in `directory` survive a power failure. File systems that cannot
// do it for directories say EINVAL, and there is nothing better to do then.
void sync_directory(const fs::path& directory) {
  const Descriptor opened(::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!opened.valid() || (::fsync(opened.get()) != 0 && errno != EINVAL)) {
    throw Failure("cannot sync directory {}: {}", directory.string(), reason());
  }
}

fs::path parent_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

// Turns the standard library's error into one of ours.
template <typename Action>
void on_disk(const char* what, const fs::path& path, const Action& action) {
  try {
    action();
  } catch (const fs::filesystem_error& error) {
    throw Failure("cannot {} {}: {}", what, path.string(), error.code().message());
  }
}

std::optional<std::uint64_t> round_of(std::string_view name) {
  std::uint64_t round = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), round);
  if (error != std::errc() || end != name.data() + name.size()) return std::nullopt;
  return round;
}

fs::path checkpoints_of(const fs::path& root) { return root / "checkpoints"; }
fs::path partial_checkpoint(const fs::path& root, std::uint64_t round) {
  return checkpoints_of(root) / (std::to_string(round) + ".partial");
}

std::string hash_of(std::string_view content) {
  Hash hash;
  hash.add(content.data(), content.size());
  return hash.hex();
}

// Keeps the newest `kept` checkpoints up to `round`. Later ones are left over from a continuation
// that was given up, as are half-written ones.
void remove_old_checkpoints(const fs::path& directory, std::uint64_t round, int kept) {
  std::vector<std::uint64_t> rounds;
  std::vector<fs::path> doomed;
  for (const auto& entry : fs::directory_iterator(directory)) {
    if (!entry.is_directory()) continue;
    const auto found = round_of(entry.path().filename().string());
    if (found && *found <= round) {
      rounds.push_back(*found);
    } else {
      doomed.push_back(entry.path());
    }
  }
  std::sort(rounds.rbegin(), rounds.rend());
  const auto first_old = std::min(rounds.size(), static_cast<std::size_t>(std::max(kept, 1)));
  for (std::size_t i = first_old; i < rounds.size(); ++i) {
    doomed.push_back(directory / std::to_string(rounds[i]));
  }
  for (const fs::path& path : doomed) fs::remove_all(path);
}

void check_file(const fs::path& file, const json& expected) {
  const std::string content = read_file(file);
  if (content.size() != whole_number<std::uint64_t>(expected.at("size")) ||
      hash_of(content) != expected.at("xxh3").get<std::string>()) {
    throw Failure("{} is damaged: its size or hash is not what the manifest beside it says",
                  file.string());
  }
}

}  // namespace

void write_file(const fs::path& file, std::string_view content) {
  const fs::path temporary = file.string() + ".tmp-" + std::to_string(getpid());
  Descriptor out(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
  const bool written = out.valid() && write_all(out.get(), content) && ::fsync(out.get()) == 0 &&
                       out.close() && ::rename(temporary.c_str(), file.c_str()) == 0;
  if (!written) {
    const std::string why = reason();
    ::unlink(temporary.c_str());
    throw Failure("cannot write {}: {}", file.string(), why);
  }
  sync_directory(parent_of(file));
}

std::string read_file(const fs::path& file) {
  const Descriptor in(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  struct stat status {};
  if (!in.valid() || ::fstat(in.get(), &status) != 0) {
    throw Failure("cannot read {}: {}", file.string(), reason());
  }
  std::string content(static_cast<std::size_t>(status.st_size), '\0');
  std::size_t filled = 0;
  while (true) {
    // One byte more than the size says, to see a file that grows or has no size (/proc).
    if (filled == content.size()) content.resize(filled + std::max<std::size_t>(filled / 2, 4096));
    const ssize_t got = ::read(in.get(), content.data() + filled, content.size() - filled);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw Failure("cannot read {}: {}", file.string(), reason());
    if (got == 0) break;
    filled += static_cast<std::size_t>(got);
  }
  content.resize(filled);
  return content;
}

json read_json(const fs::path& file) {
  const std::string content = read_file(file);
  try {
    return json::parse(content);
  } catch (const json::exception& error) {
    throw Failure("{} is not JSON: {}", file.string(), error.what());
  }
}

RunDirectory RunDirectory::create(const fs::path& root) {
  on_disk("create", root, [&] {
    if (fs::exists(root)) {
      throw Failure("{} exists already: continue it with `corridor resume`, or choose another name",
                    root.string());
    }
    for (const char* name : {"sumo", "log", "metrics", "checkpoints", "evaluation/episodes"}) {
      fs::create_directories(root / name);
    }
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
  return directory;
}

fs::path RunDirectory::log(std::string_view process) const {
  return root_ / "log" / (std::string(process) + ".log");
}

fs::path RunDirectory::metrics(std::string_view process) const {
  return root_ / "metrics" / (std::string(process) + ".jsonl");
}

fs::path RunDirectory::begin_checkpoint(std::uint64_t round) const {
  const fs::path directory = partial_checkpoint(root_, round);
  on_disk("create", directory, [&] {
    fs::remove_all(directory);
    fs::create_directories(directory);
  });
  return directory;
}

void RunDirectory::commit_checkpoint(std::uint64_t round, int kept) const {
  const fs::path partial = partial_checkpoint(root_, round);
  const fs::path checkpoints = checkpoints_of(root_);
  const std::string name = std::to_string(round);
  on_disk("complete checkpoint", partial, [&] {
    json files = json::object();
    for (const auto& entry : fs::directory_iterator(partial)) {
      const std::string content = read_file(entry.path());
      files[entry.path().filename().string()] = {{"size", content.size()},
                                                 {"xxh3", hash_of(content)}};
    }
    write_file(partial / "manifest.json", json{{"round", round}, {"files", files}}.dump(2) + "\n");
    // One that is there already is left over: a run goes on from CURRENT, to later rounds.
    fs::remove_all(checkpoints / name);
    fs::rename(partial, checkpoints / name);
    sync_directory(checkpoints);
    write_file(checkpoints / "CURRENT", name + "\n");
    remove_old_checkpoints(checkpoints, round, kept);
  });
}

std::optional<fs::path> RunDirectory::newest_checkpoint() const {
  const fs::path current = checkpoints_of(root_) / "CURRENT";
  std::error_code ignored;
  if (!fs::exists(current, ignored)) return std::nullopt;
  std::string name = read_file(current);
  if (name.ends_with('\n')) name.pop_back();
  const auto round = round_of(name);
  if (!round) throw Failure("{} is damaged: it names no checkpoint", current.string());

  const fs::path directory = checkpoints_of(root_) / name;
  const fs::path manifest_file = directory / "manifest.json";
  const json manifest = read_json(manifest_file);
  try {
    if (whole_number<std::uint64_t>(manifest.at("round")) != *round) {
      throw Failure("{} is damaged: it is of another round", manifest_file.string());
    }
    for (const auto& [file, expected] : manifest.at("files").items()) {
      check_file(directory / file, expected);
    }
  } catch (const json::exception& error) {
    throw Failure("{} is damaged: {}", manifest_file.string(), error.what());
  }
  return directory;
}

RunManifest read_manifest(const RunDirectory& directory) {
  const json manifest = read_json(directory.manifest());
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

Addresses addresses(const RunSettings& settings, const std::string& run_id) {
  if (settings.transport == "tcp") {
    return {fmt::format("tcp://{}:{}", settings.host, settings.replay_port),
            fmt::format("tcp://{}:{}", settings.host, settings.learner_port)};
  }
  const std::string name = hash_of(run_id);
  return {fmt::format("ipc://@corridor-{}-replay", name),
          fmt::format("ipc://@corridor-{}-learner", name)};
}

}  // namespace corridor
