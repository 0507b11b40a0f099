// SPDX-License-Identifier: Apache-2.0
// Processes that this one has started, each the leader of a process group of its own. Whatever is
// still there when the object goes is killed; when this process dies, the kernel kills them.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <list>
#include <map>
#include <optional>
#include <string>

#include "cluster/launch/plan.h"
#include "proto/system/clock.h"
#include "proto/system/processors.h"
#include "proto/system/pulse.h"

namespace corridor::cluster {

// A process that has ended.
struct Ended {
  std::string name;
  std::filesystem::path log;
  std::uintmax_t log_start = 0;       // what is before is of earlier processes
  int status = 0;                     // as waitpid says
  std::optional<double> hung_s = {};  // it was killed for so long a silence

  // With status 0.
  bool well() const;
  // By itself, with one line that says what is wrong: trying again would end the same way.
  bool knows_why() const;
  // "learner ended with signal 9 (Killed): <its last words>; log: <file>"
  std::string cause() const;
};

// How long a process may give no sign of life.
struct Silence {
  std::chrono::milliseconds working{20'000};
  std::chrono::milliseconds loading{120'000};  // before the first one: libraries come from a disk
};

class Children {
 public:
  Children() = default;
  ~Children() { kill_all(); }
  Children(const Children&) = delete;
  Children& operator=(const Children&) = delete;

  // Throws Failure when the program cannot be started. One that has neither become its program nor
  // said why it cannot when `patience` is over is started all the same, and found as hung.
  void start(const ProcessPlan& plan, std::chrono::milliseconds patience = std::chrono::seconds(2));

  // One that has ended since, together with what was left of its group.
  std::optional<Ended> reap();

  // To all, or to one.
  void signal(int signal, const std::string& only = {});
  // Those that have given no sign of life (proto/system/pulse.h) for so long, by the calls of this
  // function, which are to come several times a second. What a process waits for a processor that
  // others have does not count, nor what this process was stopped. The limits of one that was
  // killed so are doubled each time. `now` never steps back.
  void kill_hung(const Silence& limits, TimePoint now);
  // At its return none is left.
  void kill_all();

  std::size_t size() const { return running_.size(); }
  bool has(const std::string& name) const;

 private:
  struct Child {
    std::string name;
    std::filesystem::path log;
    std::uintmax_t log_start = 0;
    pid_t pid = 0;  // of the process and its group
    Pulse pulse;
    // When last looked at.
    std::uint64_t beats = 0;
    ProcessorTime time;
    std::optional<TimePoint> looked_at;
    TimePoint::duration silence{0};
    std::optional<double> hung_s;
  };
  std::uint32_t starts_ = 0;
  std::list<Child> running_;
  std::map<std::string, int> hangs_;  // of each name
};

}  // namespace corridor::cluster
