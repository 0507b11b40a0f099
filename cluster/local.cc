#include "cluster/local.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>

#include "proto/failure.h"
#include "proto/program.h"

namespace corridor::cluster {
namespace {

using Clock = std::chrono::steady_clock;

// Signals as readable events, as long as it lives.
class Signals {
 public:
  Signals() {
    sigset_t watched;
    sigemptyset(&watched);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGCHLD}) sigaddset(&watched, signal);
    sigprocmask(SIG_BLOCK, &watched, &before_);
    descriptor_ = signalfd(-1, &watched, SFD_CLOEXEC | SFD_NONBLOCK);
    if (descriptor_ < 0) throw Failure("cannot watch signals: {}", std::strerror(errno));
  }
  ~Signals() {
    close(descriptor_);
    sigprocmask(SIG_SETMASK, &before_, nullptr);
  }
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  // Returns after `patience`, or earlier with a stop signal, or with nothing when a child changed.
  std::optional<int> wait(Milliseconds patience) {
    pollfd watched{descriptor_, POLLIN, 0};
    poll(&watched, 1, static_cast<int>(std::max<Milliseconds::rep>(0, patience.count())));
    signalfd_siginfo event;
    while (read(descriptor_, &event, sizeof event) == static_cast<ssize_t>(sizeof event)) {
      if (event.ssi_signo != SIGCHLD) return static_cast<int>(event.ssi_signo);
    }
    return std::nullopt;
  }

 private:
  int descriptor_ = -1;
  sigset_t before_;
};

struct Child {
  std::string name;
  std::filesystem::path log;
  std::uintmax_t log_start = 0;  // what is before is of earlier processes
  pid_t pid = 0;                 // of the process and its group
};

struct Ended {
  Child child;
  int status = 0;  // as waitpid says
  bool well() const { return WIFEXITED(status) && WEXITSTATUS(status) == 0; }
};

std::vector<std::string> environment_of_children() {
  // The processes share the cores already: threads of their own would only get in each other's way.
  std::vector<std::string> result = {"OMP_NUM_THREADS=1", "OPENBLAS_NUM_THREADS=1"};
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    if (!text.starts_with("OMP_NUM_THREADS=") && !text.starts_with("OPENBLAS_NUM_THREADS=")) {
      result.emplace_back(text);
    }
  }
  return result;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

// Between fork and exec: calls only what is safe there. Does not return.
[[noreturn]] void become(char* const* argv, char* const* environment, int log, int errors,
                         pid_t parent) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(1);  // it died before prctl
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
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

// Children of this process, each the leader of a process group of its own. Owns them: whatever is
// still there at the end is killed.
class Children {
 public:
  Children() = default;
  ~Children() { kill_all(); }
  Children(const Children&) = delete;
  Children& operator=(const Children&) = delete;

  void start(const ProcessPlan& plan);

  // One that has ended since, together with what was left of its group.
  std::optional<Ended> reap();

  void signal(int signal, const std::string& only = {}) {
    for (const Child& child : running_) {
      if (only.empty() || child.name == only) kill(-child.pid, signal);
    }
  }

  void kill_all() {
    signal(SIGKILL);
    // The kernel ends them within moments; the deadline is for one stuck in a broken device.
    const auto deadline = Clock::now() + std::chrono::seconds(2);
    while (!running_.empty() && Clock::now() < deadline) {
      if (!reap()) poll(nullptr, 0, 1);
    }
    running_.clear();
  }

  std::size_t size() const { return running_.size(); }
  bool has(const std::string& name) const {
    return std::any_of(running_.begin(), running_.end(),
                       [&](const Child& child) { return child.name == name; });
  }

 private:
  std::vector<Child> running_;
};

void Children::start(const ProcessPlan& plan) {
  std::vector<std::string> arguments = plan.argv;
  std::vector<std::string> environment = environment_of_children();
  const std::vector<char*> argv = pointers(arguments);
  const std::vector<char*> envp = pointers(environment);

  const int log = open(plan.log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (log < 0) throw Failure("cannot write {}: {}", plan.log.string(), std::strerror(errno));
  const off_t log_start = lseek(log, 0, SEEK_END);
  // Closed by a successful exec, so that its failure is known here, with the reason.
  int errors[2];
  if (pipe2(errors, O_CLOEXEC) != 0) {
    const int error = errno;
    close(log);
    throw Failure("cannot start {}: {}", plan.name, std::strerror(error));
  }
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid == 0) become(argv.data(), envp.data(), log, errors[1], parent);
  int error = pid < 0 ? errno : 0;
  close(log);
  close(errors[1]);
  if (pid > 0) {
    setpgid(pid, pid);  // here as well: whoever comes first
    running_.push_back({plan.name, plan.log, static_cast<std::uintmax_t>(log_start), pid});
    if (read(errors[0], &error, sizeof error) < 0) error = errno;
  }
  close(errors[0]);
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
    Ended ended{*child, 0};
    waitpid(child->pid, &ended.status, WNOHANG);
    running_.erase(child);
    return ended;
  }
  return std::nullopt;
}

// The last line that names an error, or else the last line, of what the process wrote.
std::string last_words(const Child& child) {
  std::ifstream log(child.log);
  log.seekg(static_cast<std::streamoff>(child.log_start));
  std::string last;
  bool is_error = false;
  for (std::string line; std::getline(log, line);) {
    const bool names_error = line.find("error") != std::string::npos;
    if (line.empty() || (is_error && !names_error)) continue;
    last = line;
    is_error = names_error;
  }
  if (last.empty()) return "it wrote nothing";
  return is_error ? last : "its last line: " + last;
}

Failure failure_of(const Ended& ended) {
  const std::string status =
      WIFSIGNALED(ended.status)
          ? fmt::format("signal {} ({})", WTERMSIG(ended.status), strsignal(WTERMSIG(ended.status)))
          : fmt::format("status {}", WEXITSTATUS(ended.status));
  return Failure("{} ended with {}: {}; log: {}", ended.child.name, status, last_words(ended.child),
                 ended.child.log.string());
}

// Waits until `done` says so, at most `patience`. A repeated stop signal kills all.
void wait_for_end(Children& children, Signals& signals, Milliseconds patience,
                  Clock::time_point repeated_from, const std::function<bool()>& done) {
  const auto deadline = Clock::now() + patience;
  while (true) {
    while (children.reap()) {
    }
    const auto left = std::chrono::ceil<Milliseconds>(deadline - Clock::now());
    if (done() || left.count() <= 0) return;
    if (signals.wait(left) && Clock::now() >= repeated_from) children.kill_all();
  }
}

// Ends `first` (when there is one), then all.
void stop(Children& children, Signals& signals, const std::string& first, const Limits& limits,
          Milliseconds patience) {
  const auto repeated_from = Clock::now() + limits.repeated_signal;
  if (!first.empty() && children.has(first)) {
    children.signal(SIGTERM, first);
    wait_for_end(children, signals, limits.checkpoint, repeated_from,
                 [&] { return !children.has(first); });
  }
  children.signal(SIGTERM);
  wait_for_end(children, signals, patience, repeated_from, [&] { return children.size() == 0; });
  children.kill_all();
}

}  // namespace

Ending run_together(const std::vector<ProcessPlan>& plan, const std::string& main_process,
                    const Limits& limits, const std::function<void()>& tick) {
  Signals signals;
  if (stop_requested()) return {SIGINT};
  Children children;
  for (const ProcessPlan& process : plan) children.start(process);
  while (true) {
    tick();
    if (const std::optional<int> signal = signals.wait(limits.tick)) {
      stop(children, signals, main_process, limits, limits.others);
      return {*signal};
    }
    // Others may fail just because the main process has ended well: all ends are read first.
    std::optional<Ended> failed;
    bool done = false;
    while (const std::optional<Ended> ended = children.reap()) {
      if (ended->child.name == main_process && ended->well()) done = true;
      if (!ended->well() && !failed) failed = ended;
    }
    if (done) {
      stop(children, signals, "", limits, limits.after_work);
      return {};
    }
    if (failed) {
      stop(children, signals, main_process, limits, limits.others);
      throw failure_of(*failed);
    }
  }
}

Ending run_queue(const std::vector<ProcessPlan>& plan, int jobs, const Limits& limits,
                 const std::function<void()>& tick) {
  CORRIDOR_CHECK(jobs > 0, "{} jobs", jobs);
  Signals signals;
  if (stop_requested()) return {SIGINT};
  Children children;
  std::size_t next = 0;
  while (true) {
    while (next < plan.size() && children.size() < static_cast<std::size_t>(jobs)) {
      children.start(plan[next++]);
    }
    tick();
    if (children.size() == 0) return {};
    if (const std::optional<int> signal = signals.wait(limits.tick)) {
      stop(children, signals, "", limits, limits.others);
      return {*signal};
    }
    while (const std::optional<Ended> ended = children.reap()) {
      if (ended->well()) continue;
      stop(children, signals, "", limits, limits.others);
      throw failure_of(*ended);
    }
  }
}

std::filesystem::path program_directory() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

int available_cores() {
  cpu_set_t cores;
  return sched_getaffinity(0, sizeof cores, &cores) == 0 ? CPU_COUNT(&cores) : 1;
}

}  // namespace corridor::cluster
