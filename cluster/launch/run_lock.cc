// SPDX-License-Identifier: Apache-2.0
#include "cluster/launch/run_lock.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <sstream>
#include <string>

#include "proto/base/failure.h"
#include "proto/system/clock.h"
#include "proto/system/identity.h"
#include "proto/system/program.h"

namespace corridor::cluster {
namespace {

// What the lock file says: "<pid> <host>".
struct Owner {
  pid_t pid = 0;
  std::string host;

  bool gone() const { return host == host_name() && kill(pid, 0) != 0 && errno == ESRCH; }
};

Owner read_owner(int descriptor) {
  std::array<char, 512> text{};
  Owner owner;
  if (pread(descriptor, text.data(), text.size() - 1, 0) > 0) {
    std::istringstream(text.data()) >> owner.pid >> owner.host;
  }
  return owner;
}

}  // namespace

Descriptor lock_folder(const std::filesystem::path& folder, std::chrono::milliseconds patience) {
  const std::filesystem::path file = folder / "lock";
  // Not close-on-exec: the run's processes are to hold it too.
  Descriptor lock(open(file.c_str(), O_RDWR | O_CREAT, 0644));
  if (!lock.valid()) throw Failure("cannot open {}: {}", file.string(), std::strerror(errno));
  const TimePoint deadline = steady_now() + patience;
  while (flock(lock.get(), LOCK_EX | LOCK_NB) != 0) {
    const Owner owner = read_owner(lock.get());
    if (owner.gone() && steady_now() < deadline && !stop_requested()) {
      poll(nullptr, 0, 50);
      continue;
    }
    throw Failure("{} is going on: process {} on {} runs it{}", folder.string(), owner.pid,
                  owner.host,
                  owner.gone() ? " (it is gone, but processes that it started still live)" : "");
  }
  const std::string text = fmt::format("{} {}\n", getpid(), host_name());
  if (ftruncate(lock.get(), 0) != 0 ||
      pwrite(lock.get(), text.data(), text.size(), 0) != static_cast<ssize_t>(text.size())) {
    throw Failure("cannot write {}: {}", file.string(), std::strerror(errno));
  }
  return lock;
}

}  // namespace corridor::cluster
