// SPDX-License-Identifier: Apache-2.0
// Runs a program as a user would, with its output captured and a deadline.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace corridor::testing_support {

struct CommandResult {
  int status = -1;     // exit status; 128 + signal when a signal ended it
  std::string output;  // standard output and standard error together
  double seconds = 0.0;
};

// A program under way. Killed, if it still runs, when the object goes.
class Command {
 public:
  explicit Command(const std::vector<std::string>& arguments,
                   const std::map<std::string, std::string>& environment = {}) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("pipe");
    pid_ = fork();
    if (pid_ < 0) throw std::runtime_error("fork");
    if (pid_ == 0) {
      setpgid(0, 0);  // as a shell with job control does
      dup2(ends[1], STDOUT_FILENO);
      dup2(ends[1], STDERR_FILENO);
      for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
      std::vector<char*> argv;
      for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
      argv.push_back(nullptr);
      execvp(argv[0], argv.data());
      _exit(127);
    }
    close(ends[1]);
    output_ = ends[0];
  }
  ~Command() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    close(output_);
  }
  Command(const Command&) = delete;
  Command& operator=(const Command&) = delete;

  pid_t pid() const { return pid_; }
  void signal(int number) const { kill(pid_, number); }

  // Reads on until the output contains `text`; false when the program ends or `seconds` pass first.
  bool wait_for(const std::string& text, double seconds) {
    const auto deadline = deadline_in(seconds);
    while (text_.find(text) == std::string::npos) {
      if (Clock::now() > deadline || !read_some(deadline)) return false;
    }
    return true;
  }

  // Reads for so long; false when the program ends first.
  bool read_for(double seconds) {
    const auto deadline = deadline_in(seconds);
    while (Clock::now() < deadline) {
      if (!read_some(deadline)) return false;
    }
    return true;
  }

  // Waits for the end. A program that has not ended by the deadline is killed: status 137.
  CommandResult finish(double seconds) {
    const auto deadline = deadline_in(seconds);
    while (Clock::now() < deadline && read_some(deadline)) {
    }
    if (Clock::now() >= deadline) kill(pid_, SIGKILL);
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    const double passed = std::chrono::duration<double>(Clock::now() - start_).count();
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), text_, passed};
  }

 private:
  using Clock = std::chrono::steady_clock;

  static Clock::time_point deadline_in(double seconds) {
    return Clock::now() +
           std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  }

  // False at the end of the output.
  bool read_some(Clock::time_point deadline) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    pollfd ready{output_, POLLIN, 0};
    if (poll(&ready, 1, static_cast<int>(left > 0 ? left : 0)) <= 0) return true;
    char buffer[4096];
    const ssize_t count = read(output_, buffer, sizeof buffer);
    if (count > 0) text_.append(buffer, static_cast<std::size_t>(count));
    return count > 0;
  }

  Clock::time_point start_ = Clock::now();
  pid_t pid_ = -1;
  int output_ = -1;
  std::string text_;
};

inline CommandResult run_command(const std::vector<std::string>& arguments, double seconds,
                                 const std::map<std::string, std::string>& environment = {}) {
  return Command(arguments, environment).finish(seconds);
}

}  // namespace corridor::testing_support
