#include "cluster/gnuplot.h"

#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

extern "C" {  // glibc 2.36 forgets it
#include <sys/pidfd.h>
}

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <optional>

#include "proto/failure.h"

namespace corridor::cluster {
namespace {

// A file in memory: whoever reads or writes it never waits for the other side.
class MemoryFile {
 public:
  explicit MemoryFile(const std::string& content = {})
      : descriptor_(memfd_create("gnuplot", MFD_CLOEXEC)) {
    if (descriptor_ < 0) throw Failure("cannot run gnuplot: {}", std::strerror(errno));
    for (std::size_t done = 0; done < content.size();) {
      const ssize_t count = write(descriptor_, content.data() + done, content.size() - done);
      if (count <= 0) {
        const int error = errno;
        close(descriptor_);
        throw Failure("cannot run gnuplot: {}", std::strerror(error));
      }
      done += static_cast<std::size_t>(count);
    }
    lseek(descriptor_, 0, SEEK_SET);
  }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  int descriptor() const { return descriptor_; }

  std::string content() const {
    std::string text;
    char buffer[65536];
    for (ssize_t count; (count = pread(descriptor_, buffer, sizeof buffer,
                                       static_cast<off_t>(text.size()))) > 0;) {
      text.append(buffer, static_cast<std::size_t>(count));
    }
    return text;
  }

 private:
  int descriptor_;
};

pid_t start(const MemoryFile& in, const MemoryFile& out, const MemoryFile& errors) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, in.descriptor(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, out.descriptor(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, errors.descriptor(), STDERR_FILENO);
  char program[] = "gnuplot", no_user_settings[] = "--default-settings";
  char* const argv[] = {program, no_user_settings, nullptr};
  pid_t pid = -1;
  const int error = posix_spawnp(&pid, program, &files, nullptr, argv, environ);
  posix_spawn_file_actions_destroy(&files);
  if (error == ENOENT) {
    throw Failure("gnuplot is not installed, and it draws the figures: install gnuplot-nox");
  }
  if (error != 0) throw Failure("cannot start gnuplot: {}", std::strerror(error));
  return pid;
}

// Its status as waitpid says; nothing when it had to be killed. In either case it is gone then.
std::optional<int> wait_for(pid_t pid, std::chrono::milliseconds patience) {
  using Clock = std::chrono::steady_clock;
  const auto deadline = Clock::now() + patience;
  pollfd ended{pidfd_open(pid, 0), POLLIN, 0};
  int ready = 0;
  do {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
    ready = poll(&ended, 1, static_cast<int>(std::max<std::int64_t>(left, 0)));
  } while (ready < 0 && errno == EINTR);
  close(ended.fd);
  if (ready <= 0) kill(pid, SIGKILL);
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  if (ready <= 0) return std::nullopt;
  return status;
}

// gnuplot says the line, then marks the place, then says what is wrong.
std::string last_line(std::string text) {
  text.erase(text.find_last_not_of(" \n") + 1);
  text.erase(0, text.rfind('\n') + 1);
  text.erase(0, text.find_first_not_of(' '));
  return text;
}

}  // namespace

std::string run_gnuplot(const std::string& script, std::chrono::milliseconds deadline) {
  const MemoryFile in(script), out, errors;
  const std::optional<int> status = wait_for(start(in, out, errors), deadline);
  if (!status) {
    throw Failure("gnuplot was not done within {} s and was killed",
                  std::chrono::duration<double>(deadline).count());
  }
  if (WIFSIGNALED(*status)) {
    throw Failure("gnuplot ended with signal {}", strsignal(WTERMSIG(*status)));
  }
  const std::string picture = out.content();
  if (WEXITSTATUS(*status) != 0 || picture.empty()) {
    throw Failure("gnuplot drew nothing: {}", last_line(errors.content()));
  }
  return picture;
}

}  // namespace corridor::cluster
