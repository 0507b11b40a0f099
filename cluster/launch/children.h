// SPDX-License-Identifier: Apache-2.0
// Processes that this one has started, each the leader of a process group of its own. Whatever is
// still there when the object goes is killed; when this process dies, the kernel kills them.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <list>
#include <optional>
#include <string>

#include "cluster/launch/plan.h"
#include "proto/system/clock.h"
#include "proto/system/pulse.h"

namespace corridor::cluster {

// A process that has ended.
struct Ended {
  std::string name;
  std::filesystem::path log;
  std::uintmax_t log_start = 0;  // what is before is of earlier processes
  int status = 0;                // as waitpid says
  bool hung = false;             // it was killed for that

  // With status 0.
  bool well() const;
  // By itself, with one line that says what is wrong: trying again would end the same way.
  bool knows_why() const;
  // "learner ended with signal 9 (Killed): <its last words>; log: <file>"
  std::string cause() const;
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
  // function, which are to come far more often. `now` never steps back.
  void kill_hung(std::chrono::milliseconds silence, TimePoint now);
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
    std::uint64_t beats = 0;            // when last looked at
    std::optional<TimePoint> alive_at;  // when they were last more than before
    bool hung = false;
  };
  std::uint32_t starts_ = 0;
  std::list<Child> running_;
};

}  // namespace corridor::cluster
