#include "proto/run_directory.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "proto/failure.h"
#include "proto/hash.h"
#include "proto/settings.h"

namespace corridor {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Follows the name of a file that is being written.
constexpr const char* kTemporary = ".tmp-";

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

fs::path parent_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

std::string hash_of(std::string_view content) {
  Hash hash;
  hash.add(content.data(), content.size());
  return hash.hex();
}

// File systems that cannot do it for directories say EINVAL, and there is nothing better to do
// then.
void sync(const fs::path& path, int flags) {
  const Descriptor opened(::open(path.c_str(), O_RDONLY | O_CLOEXEC | flags));
  if (!opened.valid() || (::fsync(opened.get()) != 0 && errno != EINVAL)) {
    throw Failure("cannot sync {}: {}", path.string(), reason());
  }
}

void create_folders(const fs::path& root) {
  for (const char* name : {"sumo", "log", "metrics", "checkpoints", "evaluation/episodes"}) {
    fs::create_directories(root / name);
  }
}

}  // namespace

void sync_file(const fs::path& file) { sync(file, 0); }
void sync_directory(const fs::path& directory) { sync(directory, O_DIRECTORY); }

void write_file(const fs::path& file, std::string_view content) {
  const fs::path temporary = file.string() + kTemporary + std::to_string(getpid());
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
      const std::string name = entry.path().filename().string();
      if (name.find(kTemporary) != std::string::npos || name.ends_with(".partial")) {
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
