// SPDX-License-Identifier: Apache-2.0
#include "actor/what_if.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <exception>
#include <optional>
#include <string_view>
#include <utility>

#include "proto/base/failure.h"
#include "proto/system/clock.h"

namespace corridor::actor {
namespace {

// First byte of what the copy says; the rest is the result, or the error's text.
constexpr std::uint8_t kReturned = 0;
constexpr std::uint8_t kThrew = 1;

Bytes said(std::uint8_t how, std::string_view text) {
  Bytes bytes(1 + text.size(), how);
  std::ranges::copy(text, bytes.begin() + 1);
  return bytes;
}

Bytes call(const std::function<Bytes()>& function) {
  try {
    Bytes bytes = function();
    bytes.insert(bytes.begin(), kReturned);
    return bytes;
  } catch (const std::exception& error) {
    return said(kThrew, error.what());
  } catch (...) {
    return said(kThrew, "an exception of unknown type");
  }
}

// The copy's whole life. It ends without destructors and without writing out buffers: both are the
// original's to do.
[[noreturn]] void live(const std::function<Bytes()>& function, int result, pid_t original) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != original) _exit(1);  // it died before prctl
  const Bytes bytes = call(function);
  for (std::size_t written = 0; written < bytes.size();) {
    const ssize_t count = write(result, bytes.data() + written, bytes.size() - written);
    if (count < 0 && errno != EINTR) _exit(1);
    if (count > 0) written += static_cast<std::size_t>(count);
  }
  _exit(0);
}

// The copy, seen from the original. Killed, if it still lives, when the object goes.
class Copy {
 public:
  explicit Copy(const std::function<Bytes()>& function) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw Failure("cannot make a pipe: {}", std::strerror(errno));
    const pid_t original = getpid();
    pid_ = fork();
    if (pid_ == 0) live(function, ends[1], original);
    const int error = errno;
    close(ends[1]);
    result_ = ends[0];
    if (pid_ > 0) return;
    close(result_);
    throw Failure("cannot copy the process: {}", std::strerror(error));
  }
  ~Copy() {
    close(result_);
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    wait();
  }
  Copy(const Copy&) = delete;
  Copy& operator=(const Copy&) = delete;

  // All that it says until it ends; nothing when it has not ended by the deadline.
  std::optional<Bytes> listen(TimePoint deadline) {
    Bytes bytes;
    std::array<std::uint8_t, 4096> buffer;
    while (true) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - steady_now());
      if (left.count() <= 0) return std::nullopt;
      pollfd ready{result_, POLLIN, 0};
      if (poll(&ready, 1, static_cast<int>(left.count())) <= 0) continue;
      const ssize_t count = read(result_, buffer.data(), buffer.size());
      if (count == 0) return bytes;
      if (count > 0) bytes.insert(bytes.end(), buffer.begin(), buffer.begin() + count);
    }
  }

  // Of a copy that has ended or ends: its status, as waitpid says.
  int wait() {
    int status = 0;
    while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = 0;
    return status;
  }

 private:
  pid_t pid_ = 0;
  int result_ = -1;
};

}  // namespace

Bytes what_if(const std::function<Bytes()>& function, std::chrono::milliseconds patience) {
  Copy copy(function);
  std::optional<Bytes> bytes = copy.listen(steady_now() + patience);
  if (!bytes) throw Failure("a what-if has no result after {} ms", patience.count());
  const int status = copy.wait();
  if (WIFSIGNALED(status)) {
    throw Failure("a what-if died of signal {} ({})", WTERMSIG(status),
                  strsignal(WTERMSIG(status)));
  }
  if (status != 0 || bytes->empty()) throw Failure("a what-if ended without a result");
  const std::uint8_t how = bytes->front();
  bytes->erase(bytes->begin());
  if (how == kThrew) throw Failure("{}", std::string(bytes->begin(), bytes->end()));
  return *std::move(bytes);
}

}  // namespace corridor::actor
