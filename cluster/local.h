// Processes on this machine: start, watch, stop. Nothing that is started here outlives its
// starter: not after an error, a signal or a crash of either.
//
// One thread; while a run_... function goes on, SIGINT, SIGTERM, SIGHUP and SIGCHLD are blocked and
// read from a descriptor, so no wait is longer than `Limits` say and none is missed.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "cluster/plan.h"

namespace corridor::cluster {

// Cores that this process may use.
int available_cores();

using Milliseconds = std::chrono::milliseconds;

struct Limits {
  Milliseconds tick{200};         // between two calls of `tick`, at most
  Milliseconds checkpoint{3500};  // for the learner to end once asked to
  Milliseconds others{1000};      // for the others, after it, when a signal or failure ends all
  Milliseconds after_work{3000};  // for the others, when the work is done
  // A repeated signal kills at once, but not within this time: `timeout` and shells send the
  // same one to the process and then to its group.
  Milliseconds repeated_signal{300};
};

// How the processes came to their end, when not by a failure.
struct Ending {
  int signal = 0;  // that stopped them early; 0: the work is done
};

// Starts the plan's processes and waits until `main_process` has ended with status 0, then ends the
// others. A stop signal ends `main_process` first, then the others. Any process that ends with
// another status ends all: throws Failure with its name, status, last error line and log. Also
// throws Failure when a program cannot be started.
// `tick` is called now and then from the waiting loop; what it throws ends all as well.
Ending run_together(const std::vector<ProcessPlan>& plan, const std::string& main_process,
                    const Limits& limits, const std::function<void()>& tick);

// Runs every process of the plan, at most `jobs` at a time, in order. Otherwise as run_together.
Ending run_queue(const std::vector<ProcessPlan>& plan, int jobs, const Limits& limits,
                 const std::function<void()>& tick);

// The directory of the running program: the others lie beside it.
std::filesystem::path program_directory();

}  // namespace corridor::cluster
