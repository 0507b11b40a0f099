// SPDX-License-Identifier: Apache-2.0
#include "proto/system/files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "proto/base/json.h"
#include "proto/system/descriptor.h"

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
    if (written < 0 && errno == EINTR) continue;
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

FolderInTheMaking::~FolderInTheMaking() {
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

bool is_leftover(const fs::path& file) {
  return file.filename().string().find(kTemporary) != std::string::npos;
}

}  // namespace corridor
