#include "proto/system/subprocess.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <utility>

#include "proto/base/failure.h"

namespace corridor {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kOutputBytesMax = 64 << 20;

class Descriptor {
 public:
  explicit Descriptor(int descriptor = -1) : descriptor_(descriptor) {}
  ~Descriptor() { reset(); }
  Descriptor(Descriptor&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    reset();
    descriptor_ = std::exchange(other.descriptor_, -1);
    return *this;
  }

  int get() const { return descriptor_; }
  void reset() {
    if (descriptor_ >= 0) close(std::exchange(descriptor_, -1));
  }

 private:
  int descriptor_;
};

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
        const std::string& input)
      : output_(make_pipe(program)), errors_(make_pipe(program)) {
    const Descriptor in = memory_file(input, program);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, in.get(), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&files, output_.write_end.get(), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files, errors_.write_end.get(), STDERR_FILENO);
    std::vector<std::string> words = arguments;
    words.insert(words.begin(), program.string());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const int error = posix_spawn(&pid_, argv[0], &files, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    if (error != 0) {
      pid_ = -1;
      fail(program, error);
    }
    output_.write_end.reset();
    errors_.write_end.reset();
  }
  ~Child() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // What it writes until it has closed both; false when it has not by the deadline.
  bool read_all(Clock::time_point deadline, SubprocessResult& result) {
    std::array<std::pair<Descriptor*, std::string*>, 2> streams = {
        {{&output_.read_end, &result.output}, {&errors_.read_end, &result.errors}}};
    while (output_.read_end.get() >= 0 || errors_.read_end.get() >= 0) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
      if (left.count() <= 0) return false;
      // A descriptor of -1 is none to poll.
      pollfd ready[] = {{output_.read_end.get(), POLLIN, 0}, {errors_.read_end.get(), POLLIN, 0}};
      if (poll(ready, 2, static_cast<int>(std::min<long>(left.count(), 1000))) <= 0) continue;
      for (std::size_t i = 0; i < streams.size(); ++i) {
        if (ready[i].revents != 0) read_some(*streams[i].first, *streams[i].second);
      }
    }
    return true;
  }

  // As SubprocessResult::status. Called when it is about to end.
  int wait() {
    constexpr int kPatience_ms = 1000;
    int status = 0;
    for (int waited_ms = 0; waitpid(pid_, &status, WNOHANG) == 0; ++waited_ms) {
      if (waited_ms == kPatience_ms) kill(pid_, SIGKILL);
      usleep(1000);
    }
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

 private:
  static void read_some(Descriptor& stream, std::string& text) {
    char buffer[65536];
    const ssize_t count = read(stream.get(), buffer, sizeof buffer);
    if (count == 0 || (count < 0 && errno != EINTR)) stream.reset();
    if (count > 0 && text.size() < kOutputBytesMax) {
      text.append(buffer, static_cast<std::size_t>(count));
    }
  }

  Pipe output_;
  Pipe errors_;
  pid_t pid_ = -1;
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

std::optional<SubprocessResult> run_subprocess(const fs::path& program,
                                               const std::vector<std::string>& arguments,
                                               const std::string& input,
                                               std::chrono::milliseconds patience) {
  const auto deadline = Clock::now() + patience;
  Child child(program, arguments, input);
  SubprocessResult result;
  if (!child.read_all(deadline, result)) return std::nullopt;
  result.status = child.wait();
  return result;
}

}  // namespace corridor
