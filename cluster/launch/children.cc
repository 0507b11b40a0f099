// SPDX-License-Identifier: Apache-2.0
#include "cluster/launch/children.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "proto/base/failure.h"
#include "proto/system/descriptor.h"
#include "proto/system/identity.h"
#include "proto/system/program.h"
#include "proto/system/subprocess.h"

namespace corridor::cluster {
namespace {

constexpr int kFailureStatus = 1;  // proto/system/program.h

// What counts of the time between two looks at a child: if it is more, it is we who were stopped.
constexpr std::chrono::seconds kLookedAway{1};
// The bounds of a process that has been killed for its silence grow: it may only be slow.
constexpr int kDoublingsMax = 3;

// Since `before`: what of `passed` a process was not waiting for a processor that others had.
TimePoint::duration idle_time(const ProcessorTime& before, const ProcessorTime& now,
                              TimePoint::duration passed) {
  // The system counts a wait when it is over.
  if (now.runnable && now.had == before.had) return {};
  return std::max(passed - (now.waited - before.waited), TimePoint::duration::zero());
}

std::vector<std::string> environment_of(const Pulse& pulse, std::uint32_t starts) {
  // The processes share the cores already: threads of their own would only get in each other's way.
  std::vector<std::string> result = {"OMP_NUM_THREADS=1", "OPENBLAS_NUM_THREADS=1",
                                     pulse.environment(), start_environment(starts)};
  if (const auto kernels = portable_kernels()) result.push_back(*kernels);
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    if (!text.starts_with("OMP_NUM_THREADS=") && !text.starts_with("OPENBLAS_NUM_THREADS=")) {
      result.emplace_back(text);
    }
  }
  return result;
}

// Between fork and exec: calls only what is safe there. Does not return.
[[noreturn]] void become(char* const* argv, char* const* environment, int log, int errors,
                         int pulse, pid_t parent) {
  setpgid(0, 0);
  // A run can be resumed after anything: nothing need be asked of those whose starter died.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);  // it died before prctl
  // Its starter alone is asked for a checkpoint; the rest is as a shell would start it.
  for (const int stop : kStopSignals) signal(stop, stop == SIGUSR1 ? SIG_IGN : SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  fcntl(pulse, F_SETFD, 0);
  const int null = open("/dev/null", O_RDONLY);
  dup2(null, STDIN_FILENO);
  dup2(log, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  execve(argv[0], argv, environment);
  const int error = errno;
  // Nobody is left to tell when this fails.
  if (write(errors, &error, sizeof error) < 0) _exit(126);
  _exit(127);
}

// ": <the last line that names an error>" of what the process wrote; when there is none and it
// ended by itself, the last line.
std::string last_words(const Ended& ended) {
  std::ifstream log(ended.log);
  log.seekg(static_cast<std::streamoff>(ended.log_start));
  std::string last, error;
  for (std::string line; std::getline(log, line);) {
    if (line.find("error") != std::string::npos) error = line;
    if (!line.empty()) last = line;
  }
  if (!error.empty()) return ": " + error;
  if (WIFSIGNALED(ended.status)) return "";
  return last.empty() ? ": it wrote nothing" : ": its last line: " + last;
}

}  // namespace

void Children::start(const ProcessPlan& plan, std::chrono::milliseconds patience) {
  Pulse pulse;
  std::vector<std::string> arguments = plan.argv;
  std::vector<std::string> environment = environment_of(pulse, ++starts_);
  const std::vector<char*> argv = pointers_to(arguments);
  const std::vector<char*> envp = pointers_to(environment);

  const Descriptor log(open(plan.log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644));
  if (!log.valid()) throw Failure("cannot write {}: {}", plan.log.string(), std::strerror(errno));
  const off_t log_start = lseek(log.get(), 0, SEEK_END);
  // Closed by a successful exec, so that its failure is known here, with the reason.
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) {
    throw Failure("cannot start {}: {}", plan.name, std::strerror(errno));
  }
  const Descriptor errors(ends[0]);
  Descriptor told(ends[1]);
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid == 0) become(argv.data(), envp.data(), log.get(), told.get(), pulse.descriptor(), parent);
  int error = pid < 0 ? errno : 0;
  told.close();
  if (pid > 0) {
    setpgid(pid, pid);  // here as well: whoever comes first
    running_.push_back({plan.name,
                        plan.log,
                        static_cast<std::uintmax_t>(log_start),
                        pid,
                        std::move(pulse),
                        0,
                        {},
                        std::nullopt,
                        {},
                        std::nullopt});
    pollfd said{errors.get(), POLLIN, 0};
    const bool over = poll(&said, 1, static_cast<int>(patience.count())) > 0;
    if (over && read(errors.get(), &error, sizeof error) < 0) error = errno;
  }
  if (error != 0) {
    throw Failure("cannot start {}: {}: {}; is the build complete?", plan.name, plan.argv[0],
                  std::strerror(error));
  }
}

std::optional<Ended> Children::reap() {
  for (auto child = running_.begin(); child != running_.end(); ++child) {
    siginfo_t info{};
    const auto id = static_cast<id_t>(child->pid);
    if (waitid(P_PID, id, &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid == 0) continue;
    // Before the process is reaped: its id cannot have been given to another group yet.
    kill(-child->pid, SIGKILL);
    Ended ended{child->name, child->log, child->log_start, 0, child->hung_s};
    waitpid(child->pid, &ended.status, WNOHANG);
    running_.erase(child);
    return ended;
  }
  return std::nullopt;
}

void Children::signal(int signal, const std::string& only) {
  for (const Child& child : running_) {
    if (only.empty() || child.name == only) kill(-child.pid, signal);
  }
}

void Children::kill_hung(const Silence& limits, TimePoint now) {
  for (Child& child : running_) {
    const std::uint64_t beats = child.pulse.beats();
    const ProcessorTime time = processor_time_of(child.pid);
    const ProcessorTime before = std::exchange(child.time, time);
    const TimePoint::duration passed = now - child.looked_at.value_or(now);
    child.looked_at = now;
    if (beats != std::exchange(child.beats, beats)) child.silence = {};
    child.silence += idle_time(before, time, std::min<TimePoint::duration>(passed, kLookedAway));
    const int doublings = std::min(hangs_[child.name], kDoublingsMax);
    const auto most = (beats == 0 ? limits.loading : limits.working) * (1 << doublings);
    if (child.silence < most || child.hung_s) continue;
    child.hung_s = in_seconds(child.silence);
    ++hangs_[child.name];
    kill(-child.pid, SIGKILL);
  }
}

void Children::kill_all() {
  signal(SIGKILL);
  // The kernel ends them within moments; the deadline is for one stuck in a broken device.
  const TimePoint deadline = steady_now() + std::chrono::seconds(2);
  while (!running_.empty() && steady_now() < deadline) {
    if (!reap()) poll(nullptr, 0, 1);
  }
  running_.clear();
}

bool Children::has(const std::string& name) const {
  return std::ranges::find(running_, name, &Child::name) != running_.end();
}

bool Ended::well() const { return WIFEXITED(status) && WEXITSTATUS(status) == 0; }

bool Ended::knows_why() const { return WIFEXITED(status) && WEXITSTATUS(status) == kFailureStatus; }

std::string Ended::cause() const {
  std::string how;
  if (hung_s) {
    how = fmt::format("was killed, since it gave no sign of life for {:.0f} s (run.peer_timeout_s)",
                      *hung_s);
  } else if (WIFSIGNALED(status)) {
    how = fmt::format("ended with signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
  } else {
    how = fmt::format("ended with status {}", WEXITSTATUS(status));
  }
  return fmt::format("{} {}{}; log: {}", name, how, last_words(*this), log.string());
}

}  // namespace corridor::cluster
