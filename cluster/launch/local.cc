// SPDX-License-Identifier: Apache-2.0
#include "cluster/launch/local.h"

#include <poll.h>
#include <sched.h>
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

// Signals as readable events, as long as it lives.
class Signals {
 public:
  Signals() {
    sigset_t watched;
    sigemptyset(&watched);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGCHLD}) sigaddset(&watched, signal);
    sigprocmask(SIG_BLOCK, &watched, &before_);
    descriptor_ = Descriptor(signalfd(-1, &watched, SFD_CLOEXEC | SFD_NONBLOCK));
    if (!descriptor_.valid()) throw Failure("cannot watch signals: {}", std::strerror(errno));
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
      if (event.ssi_signo != SIGCHLD) return static_cast<int>(event.ssi_signo);
    }
    return std::nullopt;
  }

 private:
  Descriptor descriptor_;
  sigset_t before_;
};

// Waits until `done` says so, at most `patience`. A repeated stop signal kills all.
void wait_for_end(Children& children, Signals& signals, const Limits& limits, Milliseconds patience,
                  TimePoint repeated_from, const std::function<bool()>& done) {
  const TimePoint deadline = limits.clock() + patience;
  while (true) {
    while (children.reap()) {
    }
    const auto left = std::chrono::ceil<Milliseconds>(deadline - limits.clock());
    if (done() || left.count() <= 0) return;
    if (signals.wait(std::min(left, limits.tick)) && limits.clock() >= repeated_from) {
      children.kill_all();
    }
  }
}

// Ends `first` (when there is one), then all.
void stop(Children& children, Signals& signals, const std::string& first, const Limits& limits,
          Milliseconds patience) {
  const TimePoint repeated_from = limits.clock() + limits.repeated_signal;
  if (!first.empty() && children.has(first)) {
    children.signal(SIGTERM, first);
    wait_for_end(children, signals, limits, limits.checkpoint, repeated_from,
                 [&] { return !children.has(first); });
  }
  children.signal(SIGTERM);
  wait_for_end(children, signals, limits, patience, repeated_from,
               [&] { return children.size() == 0; });
  children.kill_all();
}

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

int run_together(const std::vector<ProcessPlan>& plan, const std::string& main_process,
                 const Limits& limits, const Supervision& supervision) {
  Signals signals;
  if (stop_requested()) return SIGINT;
  Children children;
  const auto start_all = [&] {
    for (const ProcessPlan& process : plan) children.start(process, limits.start);
  };
  start_all();
  Deaths deaths;
  while (true) {
    beat();
    supervision.tick();
    if (const std::optional<int> signal = signals.wait(limits.tick)) {
      stop(children, signals, main_process, limits, limits.others);
      return *signal;
    }
    children.kill_hung(limits.hung, limits.clock());
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
      stop(children, signals, "", limits, limits.after_work);
      return 0;
    }
    if (dead.empty()) continue;
    const auto knows = std::ranges::find_if(dead, &Ended::knows_why);
    if (knows != dead.end()) {
      stop(children, signals, main_process, limits, limits.others);
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
  Signals signals;
  if (stop_requested()) return SIGINT;
  Children children;
  std::size_t next = 0;
  while (true) {
    while (next < plan.size() && children.size() < static_cast<std::size_t>(jobs)) {
      children.start(plan[next++], limits.start);
    }
    beat();
    tick();
    if (children.size() == 0) return 0;
    if (const std::optional<int> signal = signals.wait(limits.tick)) {
      stop(children, signals, "", limits, limits.others);
      return *signal;
    }
    children.kill_hung(limits.hung, limits.clock());
    while (const std::optional<Ended> ended = children.reap()) {
      if (ended->well()) continue;
      stop(children, signals, "", limits, limits.others);
      throw Failure("{}", ended->cause());
    }
  }
}

int available_cores() {
  cpu_set_t cores;
  return sched_getaffinity(0, sizeof cores, &cores) == 0 ? CPU_COUNT(&cores) : 1;
}

}  // namespace corridor::cluster
