// SPDX-License-Identifier: Apache-2.0
#include "proto/system/subprocess.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <utility>

#include "proto/base/failure.h"
#include "proto/system/clock.h"
#include "proto/system/descriptor.h"
#include "proto/system/program.h"

namespace corridor {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kOutputBytesMax = 64 << 20;
constexpr long kLookEvery_ms = 200;  // whether a signal has come just before a wait

[[noreturn]] void fail(const fs::path& program, int error) {
  throw Failure("cannot start {}: {}", program.string(), std::strerror(error));
}

// A file in memory: the program that reads it never waits for us, nor we for it.
Descriptor memory_file(const std::string& content, const fs::path& program) {
  Descriptor file(memfd_create("input", MFD_CLOEXEC));
  if (file.get() < 0) fail(program, errno);
  for (std::size_t done = 0; done < content.size();) {
    const ssize_t count = write(file.get(), content.data() + done, content.size() - done);
    if (count <= 0) fail(program, errno);
    done += static_cast<std::size_t>(count);
  }
  lseek(file.get(), 0, SEEK_SET);
  return file;
}

struct Pipe {
  Descriptor read_end;
  Descriptor write_end;
};

Pipe make_pipe(const fs::path& program) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) fail(program, errno);
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

// Killed and reaped, if it still runs, when the object goes.
class Child {
 public:
  Child(const fs::path& program, const std::vector<std::string>& arguments,
        const std::string& input, const fs::path& directory)
      : output_(make_pipe(program)), errors_(make_pipe(program)) {
    const Descriptor in = memory_file(input, program);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, in.get(), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&files, output_.write_end.get(), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files, errors_.write_end.get(), STDERR_FILENO);
    if (!directory.empty()) posix_spawn_file_actions_addchdir_np(&files, directory.c_str());
    std::vector<std::string> words = arguments;
    words.insert(words.begin(), fs::absolute(program).string());
    const std::vector<char*> argv = pointers_to(words);
    const int error = posix_spawn(&pid_, argv[0], &files, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    if (error != 0) {
      pid_ = -1;
      fail(program, error);
    }
    output_.write_end.close();
    errors_.write_end.close();
    // glibc 2.36 declares pidfd_open for C only.
    end_ = Descriptor(static_cast<int>(syscall(SYS_pidfd_open, pid_, 0)));
    if (end_.get() >= 0) return;
    const int reason = errno;
    end();
    fail(program, reason);
  }
  ~Child() { end(); }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // Fills `result` until there is no more to come; false when there may be, at the deadline.
  bool run(TimePoint deadline, SubprocessResult& result) {
    while (output_.read_end.get() >= 0 || errors_.read_end.get() >= 0 || end_.get() >= 0) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - steady_now());
      throw_if_stopped();
      if (left.count() <= 0) return false;
      // A descriptor of -1 is none to poll.
      pollfd ready[] = {{output_.read_end.get(), POLLIN, 0},
                        {errors_.read_end.get(), POLLIN, 0},
                        {end_.get(), POLLIN, 0}};
      if (poll(ready, 3, static_cast<int>(std::min<long>(left.count(), kLookEvery_ms))) <= 0)
        continue;
      if (ready[0].revents != 0) read_some(output_.read_end, result.output);
      if (ready[1].revents != 0) read_some(errors_.read_end, result.errors);
      if (ready[2].revents != 0) result.status = reap();
    }
    return true;
  }

 private:
  void end() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }

  // As SubprocessResult::status.
  int reap() {
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    end_.close();
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  static void read_some(Descriptor& stream, std::string& text) {
    char buffer[65536];
    const ssize_t count = read(stream.get(), buffer, sizeof buffer);
    if (count == 0 || (count < 0 && errno != EINTR)) stream.close();
    if (count > 0 && text.size() < kOutputBytesMax) {
      text.append(buffer, static_cast<std::size_t>(count));
    }
  }

  Pipe output_;
  Pipe errors_;
  pid_t pid_ = -1;  // -1: reaped
  Descriptor end_;  // readable when the process has ended
};

}  // namespace

std::optional<fs::path> find_program(const std::string& name, std::vector<fs::path> folders) {
  if (const char* path = std::getenv("PATH")) {
    std::istringstream parts(path);
    for (std::string part; std::getline(parts, part, ':');) folders.emplace_back(part);
  }
  for (const fs::path& folder : folders) {
    const fs::path program = folder / name;
    if (access(program.c_str(), X_OK) == 0) return program;
  }
  return std::nullopt;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

std::optional<SubprocessResult> run_subprocess(const fs::path& program,
                                               const std::vector<std::string>& arguments,
                                               const std::string& input,
                                               std::chrono::milliseconds patience,
                                               const fs::path& directory) {
  const TimePoint deadline = steady_now() + patience;
  Child child(program, arguments, input, directory);
  SubprocessResult result;
  if (!child.run(deadline, result)) return std::nullopt;
  return result;
}

}  // namespace corridor
