// SPDX-License-Identifier: Apache-2.0
#include "cluster/launch/local.h"

#include <poll.h>
#include <signal.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>
#include <optional>

#include "cluster/launch/children.h"
#include "proto/base/failure.h"
#include "proto/system/descriptor.h"
#include "proto/system/program.h"
#include "proto/system/pulse.h"

namespace corridor::cluster {
namespace {

sigset_t watched_signals() {
  sigset_t watched;
  sigemptyset(&watched);
  for (const int signal : kStopSignals) {
    if (!was_ignored(signal)) sigaddset(&watched, signal);
  }
  for (const int signal : {SIGCHLD, SIGTSTP}) sigaddset(&watched, signal);
  return watched;
}

// Signals as readable events, as long as it lives. Ctrl-Z, which reaches the children's process
// groups as little as Ctrl-C does, stops them and this process, and what goes on with this process
// (`fg`) goes on with them.
class Signals {
 public:
  explicit Signals(Children& children)
      : children_(children),
        watched_(watched_signals()),
        descriptor_(signalfd(-1, &watched_, SFD_CLOEXEC | SFD_NONBLOCK)) {
    if (!descriptor_.valid()) throw Failure("cannot watch signals: {}", std::strerror(errno));
    sigprocmask(SIG_BLOCK, &watched_, &before_);
  }
  ~Signals() { sigprocmask(SIG_SETMASK, &before_, nullptr); }
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  // Returns after `patience`, or earlier with a stop signal, or with nothing when a child changed.
  std::optional<int> wait(Milliseconds patience) {
    pollfd watched{descriptor_.get(), POLLIN, 0};
    poll(&watched, 1, static_cast<int>(std::max<Milliseconds::rep>(0, patience.count())));
    signalfd_siginfo event;
    while (read(descriptor_.get(), &event, sizeof event) == static_cast<ssize_t>(sizeof event)) {
      const auto signal = static_cast<int>(event.ssi_signo);
      if (signal == SIGTSTP) stop_all();
      if (signal != SIGTSTP && signal != SIGCHLD) return signal;
    }
    return std::nullopt;
  }

 private:
  void stop_all() {
    children_.signal(SIGTSTP);
    sigset_t stop;
    sigemptyset(&stop);
    sigaddset(&stop, SIGTSTP);
    raise(SIGTSTP);
    sigprocmask(SIG_UNBLOCK, &stop, nullptr);  // returns when this process goes on
    sigprocmask(SIG_BLOCK, &stop, nullptr);
    children_.signal(SIGCONT);
  }

  Children& children_;
  sigset_t watched_;
  Descriptor descriptor_;
  sigset_t before_;
};

// Ends what runs, when a signal or a failure asks for it.
class Ending {
 public:
  Ending(Children& children, Signals& signals, const Limits& limits)
      : children_(children),
        signals_(signals),
        limits_(limits),
        repeated_from_(limits.clock() + limits.repeated_signal) {}

  // Ends `first` and waits for it, as long as it lives and works, and so does what it needs; at
  // most `patience`, if given.
  void end(const std::string& first, std::optional<Milliseconds> patience) {
    if (!children_.has(first)) return;
    children_.signal(SIGTERM, first);
    wait(patience, [&] { return broken_ || !children_.has(first); });
  }
  // Ends all; those that take longer are killed.
  void end_all(Milliseconds patience) {
    children_.signal(SIGTERM);
    wait(patience, [&] { return children_.size() == 0; });
    children_.kill_all();
  }

 private:
  // A repeated stop signal kills all.
  void wait(std::optional<Milliseconds> patience, const std::function<bool()>& done) {
    const TimePoint start = limits_.clock();
    while (true) {
      beat();
      while (const std::optional<Ended> ended = children_.reap()) broken_ |= !ended->well();
      const auto left = std::chrono::ceil<Milliseconds>(
          patience.value_or(limits_.tick) - (patience ? limits_.clock() - start : Milliseconds(0)));
      if (done() || left.count() <= 0) return;
      if (signals_.wait(std::min(left, limits_.tick)) && limits_.clock() >= repeated_from_) {
        children_.kill_all();
      }
      children_.kill_hung(limits_.silence, limits_.clock());
    }
  }

  Children& children_;
  Signals& signals_;
  const Limits& limits_;
  TimePoint repeated_from_;
  bool broken_ = false;  // one has ended otherwise than well
};

// Deaths of each process since the work last advanced.
class Deaths {
 public:
  // Throws Failure when there have been too many.
  void count(const Ended& ended, std::uint64_t progress, int most) {
    if (progress > progress_) deaths_.clear();
    progress_ = std::max(progress, progress_);
    if (++deaths_[ended.name] < most) return;
    throw Failure("{} times in a row, without any progress in between: {}", most, ended.cause());
  }

 private:
  std::uint64_t progress_ = 0;
  std::map<std::string, int> deaths_;
};

const ProcessPlan& plan_of(const std::vector<ProcessPlan>& plan, const std::string& name) {
  return *std::ranges::find(plan, name, &ProcessPlan::name);
}

}  // namespace

Limits limits_of(const RunConfig& config) {
  Limits limits;
  limits.silence.working =
      Milliseconds(static_cast<std::int64_t>(config.run.peer_timeout_s * 1000.0 * 2 / 3));
  limits.silence.loading = std::max(limits.silence.loading, limits.silence.working);
  return limits;
}

int run_together(const std::vector<ProcessPlan>& plan, const std::string& main_process,
                 const Limits& limits, const Supervision& supervision) {
  Children children;
  Signals signals(children);
  if (stop_requested()) return SIGINT;
  const auto start_all = [&] {
    for (const ProcessPlan& process : plan) children.start(process, limits.start);
  };
  start_all();
  Deaths deaths;
  while (true) {
    beat();
    supervision.tick();
    if (const std::optional<int> signal = signals.wait(limits.tick)) {
      supervision.stopping();
      Ending ending(children, signals, limits);
      ending.end(main_process, std::nullopt);
      ending.end_all(limits.others);
      return *signal;
    }
    children.kill_hung(limits.silence, limits.clock());
    // Others may end just because the main process has: all ends are read first.
    std::vector<Ended> dead;
    bool done = false;
    while (const std::optional<Ended> ended = children.reap()) {
      const bool main_ended = ended->name == main_process;
      if (ended->well() && main_ended) done = true;
      if (!ended->well() || (!main_ended && !plan_of(plan, ended->name).ends_by_itself)) {
        dead.push_back(*ended);
      }
    }
    if (done) {
      Ending(children, signals, limits).end_all(limits.after_work);
      return 0;
    }
    if (dead.empty()) continue;
    const auto knows = std::ranges::find_if(dead, &Ended::knows_why);
    if (knows != dead.end()) {
      Ending ending(children, signals, limits);
      ending.end(main_process, limits.checkpoint);
      ending.end_all(limits.others);
      throw Failure("{}", knows->cause());
    }
    for (const Ended& ended : dead) deaths.count(ended, supervision.progress(), limits.deaths);
    const auto heart = std::ranges::find_if(
        dead, [&](const Ended& ended) { return !plan_of(plan, ended.name).replaceable; });
    if (heart != dead.end()) {
      children.kill_all();
      supervision.died(*heart, /*all=*/true);
      start_all();
      continue;
    }
    for (const Ended& ended : dead) {
      supervision.died(ended, /*all=*/false);
      children.start(plan_of(plan, ended.name), limits.start);
    }
  }
}

int run_queue(const std::vector<ProcessPlan>& plan, int jobs, const Limits& limits,
              const std::function<void()>& tick) {
  CORRIDOR_CHECK(jobs > 0, "{} jobs", jobs);
  Children children;
  Signals signals(children);
  if (stop_requested()) return SIGINT;
  std::size_t next = 0;
  while (true) {
    while (next < plan.size() && children.size() < static_cast<std::size_t>(jobs)) {
      children.start(plan[next++], limits.start);
    }
    beat();
    tick();
    if (children.size() == 0) return 0;
    if (const std::optional<int> signal = signals.wait(limits.tick)) {
      Ending(children, signals, limits).end_all(limits.others);
      return *signal;
    }
    children.kill_hung(limits.silence, limits.clock());
    while (const std::optional<Ended> ended = children.reap()) {
      if (ended->well()) continue;
      Ending(children, signals, limits).end_all(limits.others);
      throw Failure("{}", ended->cause());
    }
  }
}

}  // namespace corridor::cluster
