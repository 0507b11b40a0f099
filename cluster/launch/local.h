// SPDX-License-Identifier: Apache-2.0
// Processes on this machine: start, watch, stop. Nothing that is started here outlives its
// starter: not after an error, a signal or a crash of either.
//
// One thread; while a run_... function goes on, kStopSignals (proto/system/program.h), SIGTSTP and
// SIGCHLD are blocked and read from a descriptor, so no wait is longer than `Limits` say and none
// is missed.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "cluster/launch/children.h"
#include "cluster/launch/plan.h"
#include "proto/system/clock.h"

namespace corridor::cluster {

using Milliseconds = std::chrono::milliseconds;

struct Limits {
  Milliseconds tick{200};         // between two calls of `tick`, at most
  Milliseconds start{2000};       // for a process to become its program
  Milliseconds checkpoint{3500};  // for the main process to end after another one's failure
  Milliseconds others{700};       // for the others, after it, when a signal or failure ends all
  Milliseconds after_work{3000};  // for the others, when the work is done
  // A repeated signal kills at once, but not within this time: `timeout` and shells send the
  // same one to the process and then to its group.
  Milliseconds repeated_signal{300};
  Silence silence = {};      // a process without a sign of life for so long is killed
  int deaths = 5;            // of one process, without progress in between: too many
  Clock clock = steady_now;  // by which these times pass, but for `tick` and `start`
};

// As `run.peer_timeout_s` says: a process is given up before its peers take it for lost.
Limits limits_of(const RunConfig& config);

// What run_together tells and asks. All of it is called from its waiting loop; what it throws ends
// all processes.
struct Supervision {
  // Now and then.
  std::function<void()> tick = [] {};
  // A signal has come; the main process gets the time that it needs to end by itself.
  std::function<void()> stopping = [] {};
  // Grows as the work advances.
  std::function<std::uint64_t()> progress = [] { return std::uint64_t{0}; };
  // A process has died and will be started again: by itself, or all of them anew, none being left.
  std::function<void(const Ended& ended, bool all)> died = [](const Ended&, bool) {};
};

// Starts the plan's processes and waits until `main_process` has ended with status 0, then ends the
// others. A stop signal ends `main_process` first, then the others. Returns that signal, or 0 when
// the work is done, as run_queue does.
//
// A process that dies or hangs before that is started again: by itself when it is replaceable, else
// all are ended and started anew. One that ends by itself with a line that says why (status 1) ends
// all: throws Failure with its name, that line and its log; also when one dies again and again, or
// cannot be started.
int run_together(const std::vector<ProcessPlan>& plan, const std::string& main_process,
                 const Limits& limits, const Supervision& supervision);

// Runs every process of the plan, at most `jobs` at a time, in order. One that ends
// with another status than 0, or hangs, ends all: throws Failure with its name, last error line and
// log.
int run_queue(const std::vector<ProcessPlan>& plan, int jobs, const Limits& limits,
              const std::function<void()>& tick);

}  // namespace corridor::cluster
