// SPDX-License-Identifier: Apache-2.0
#include "proto/system/files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "proto/base/json.h"
#include "proto/system/program.h"

namespace corridor {
namespace {

namespace fs = std::filesystem;

// Follows the name of a file that is being written.
constexpr const char* kTemporary = ".tmp-";

// errno's text. The POSIX calls here, unlike streams, say what went wrong.
std::string reason() { return std::strerror(errno); }

bool write_all(int fd, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(fd, content.data(), content.size());
    // A pipe may wait for its reader; a disk does not end a write so.
    if (written < 0 && errno == EINTR && !stop_requested()) continue;
    if (written < 0) return false;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

// File systems that cannot do it for directories say EINVAL, and there is nothing better to do
// then.
void sync(const fs::path& path, int flags) {
  const Descriptor opened(::open(path.c_str(), O_RDONLY | O_CLOEXEC | flags));
  if (!opened.valid() || (::fsync(opened.get()) != 0 && errno != EINVAL)) {
    throw Failure("cannot sync {}: {}", path.string(), reason());
  }
}

}  // namespace

fs::path parent_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

void create_folders(const fs::path& folder, std::span<const char* const> children) {
  std::error_code error;
  fs::create_directories(folder, error);
  for (const char* child : children) {
    if (!error) fs::create_directories(folder / child, error);
  }
  if (error) throw Failure("cannot create {}: {}", folder.string(), error.message());
}

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

Json read_json(const fs::path& file) { return parse_json(read_file(file), file.string()); }

bool is_empty_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error) && fs::is_empty(path, error) && !error;
}

void check_folder_for_results(const fs::path& folder) {
  fs::path there = fs::absolute(folder);
  std::error_code error;
  while (!fs::exists(there, error) && there.has_relative_path()) there = there.parent_path();
  // With the dot, a file is no folder.
  if (::access((there / ".").c_str(), W_OK) == 0) return;
  throw Failure("cannot write to {}: {}; --out DIR puts results elsewhere", folder.string(),
                reason());
}

NewFolder::NewFolder(const fs::path& target)
    : target_(fs::absolute(target).lexically_normal()), in_target_(is_empty_folder(target)) {
  if (!target_.has_filename()) target_ = target_.parent_path();  // "runs/x/"
  const fs::path parent = in_target_ ? target_ : target_.parent_path();
  create_folders(parent);
  for (int attempt = 0;; ++attempt) {
    path_ = parent /
            fmt::format(".{}{}{}-{}", target_.filename().string(), kTemporary, getpid(), attempt);
    if (::mkdir(path_.c_str(), 0777) == 0) return;
    if (errno != EEXIST) {
      const std::string why = reason();
      throw Failure("cannot create {}: {}", target.string(), why);
    }
  }
}

NewFolder::~NewFolder() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
}

bool NewFolder::publish(const fs::path& last) {
  sync_directory(path_);
  if (!in_target_) {
    // It may take the place of a folder that is empty, and of nothing else.
    if (::rename(path_.c_str(), target_.c_str()) != 0) {
      if (errno == ENOTEMPTY || errno == EEXIST || errno == ENOTDIR) return false;
      throw Failure("cannot create {}: {}", target_.string(), reason());
    }
  } else {
    std::vector<fs::path> names;
    on_disk("fill", target_, [&] {
      if (std::distance(fs::directory_iterator(target_), {}) != 1) return;
      for (const auto& entry : fs::directory_iterator(path_)) {
        if (entry.path().filename() != last) names.push_back(entry.path().filename());
      }
      if (!last.empty()) names.push_back(last);
      for (const fs::path& name : names) fs::rename(path_ / name, target_ / name);
      fs::remove(path_);
    });
    if (names.empty()) return false;
  }
  path_.clear();
  sync_directory(target_.parent_path());
  return true;
}

OutputFile::OutputFile(fs::path file) : file_(std::move(file)) {
  if (is_standard_output()) return;
  const auto refuse = [this](const std::string& why) {
    throw Failure("cannot write {}: {}", file_.string(), why);
  };
  std::error_code error;
  const fs::file_status status = fs::status(file_, error);
  if (fs::is_directory(status)) refuse("it is a directory");
  through_ = fs::exists(status) && !fs::is_regular_file(status);
  // What a link leads to, as far as it leads anywhere. /dev/stdout and /dev/fd/3 lead into /proc.
  constexpr int kLinksMax = 40;
  fs::path place = file_;
  for (int links = 0; !through_ && fs::is_symlink(place, error) && links < kLinksMax; ++links) {
    through_ = fs::canonical(parent_of(place), error).string().starts_with("/proc/");
    place = parent_of(place) / fs::read_symlink(place, error);
  }
  if (through_ || fs::exists(status)) {
    if (::access(file_.c_str(), W_OK) != 0) refuse(reason());
  }
  if (through_) return;
  file_ = place;
  // With the dot, a file is no folder.
  if (::access((parent_of(file_) / ".").c_str(), W_OK) != 0) refuse(reason());
}

void OutputFile::write(std::string_view content) const {
  if (is_standard_output()) {
    std::fwrite(content.data(), 1, content.size(), stdout);  // run_program looks at its errors
    return;
  }
  if (!through_) {
    write_file(file_, content);
    return;
  }
  int opened = -1;
  while ((opened = ::open(file_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC)) < 0 && errno == EINTR) {
    throw_if_stopped();
  }
  Descriptor out(opened);
  if (!out.valid() || !write_all(out.get(), content) || !out.close()) {
    throw_if_stopped();
    throw Failure("cannot write {}: {}", file_.string(), reason());
  }
}

UnnamedFile::UnnamedFile() {
  const fs::path folder = fs::temp_directory_path();
  descriptor_ = Descriptor(::open(folder.c_str(), O_TMPFILE | O_RDWR, 0600));
  if (!descriptor_.valid()) {  // a file system that has no such files
    std::string name = folder / "corridor-XXXXXX";
    descriptor_ = Descriptor(::mkstemp(name.data()));
    if (descriptor_.valid()) ::unlink(name.c_str());
  }
  if (!descriptor_.valid()) {
    throw Failure("cannot create a file in {}: {}", folder.string(), reason());
  }
}

void UnnamedFile::append(std::string_view content) {
  ::lseek(descriptor_.get(), 0, SEEK_END);
  if (write_all(descriptor_.get(), content)) return;
  throw Failure("cannot write a file in {}: {}", fs::temp_directory_path().string(), reason());
}

std::string UnnamedFile::content() const { return read_file(path()); }

fs::path UnnamedFile::path() const { return fmt::format("/dev/fd/{}", descriptor_.get()); }

PlainlyNamedFolder::PlainlyNamedFolder(const fs::path& folder)
    : descriptor_(::open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC)) {
  if (!descriptor_.valid()) throw Failure("cannot open {}: {}", folder.string(), reason());
}

fs::path PlainlyNamedFolder::path() const {
  return fmt::format("/proc/self/fd/{}", descriptor_.get());
}

bool is_leftover(const fs::path& file) {
  return file.filename().string().find(kTemporary) != std::string::npos;
}

}  // namespace corridor
