// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/chaos.h"

#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>

#include "proto/base/format.h"
#include "proto/base/random.h"
#include "proto/run/run_directory.h"
#include "tests/support/command.h"
#include "tests/support/processes.h"

namespace corridor::e2e {
namespace {

namespace fs = std::filesystem;
using testing_support::Command;
using testing_support::CommandResult;
using testing_support::Process;
using testing_support::processes_with;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double disk_mb(const fs::path& root) {
  std::set<std::uint64_t> seen;
  double bytes = 0.0;
  std::error_code gone;  // files come and go meanwhile
  for (auto entry = fs::recursive_directory_iterator(root, gone);
       entry != fs::recursive_directory_iterator(); entry.increment(gone)) {
    struct stat status {};
    if (stat(entry->path().c_str(), &status) != 0 || !S_ISREG(status.st_mode)) continue;
    if (seen.insert(status.st_ino).second) bytes += static_cast<double>(status.st_size);
    if (gone) break;
  }
  return bytes / 1e6;
}

Footprint footprint_of(const std::vector<Process>& processes, const fs::path& run, double time_s) {
  Footprint result{time_s, static_cast<int>(processes.size()), 0.0, 0, disk_mb(run)};
  for (const Process& process : processes) {
    const fs::path proc = fs::path("/proc") / std::to_string(process.pid);
    std::ifstream statm(proc / "statm");
    double pages = 0.0;
    statm >> pages >> pages;
    result.memory_mb += pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
    std::error_code gone;
    for (const auto& entry : fs::directory_iterator(proc / "fd", gone)) {
      (void)entry;
      ++result.descriptors;
    }
  }
  return result;
}

// Of a launcher that was told to end: beside much else, and after one of its processes was hung, it
// may take long to see to it that all are gone.
constexpr double kEnds_s = 300.0;

class Chaos {
 public:
  Chaos(const ChaosSettings& settings, const std::function<void(const Footprint&)>& look)
      : settings_(settings), look_(look) {
    std::vector<std::string> command = settings.train;
    command.insert(command.end(), {"--run", settings.run.string()});
    launcher_.emplace(command);
  }

  ChaosResult run() {
    while (result_.trouble.empty() && !finished_) {
      const bool calm = count_ >= settings_.most;
      const double wait_s =
          calm ? settings_.deadline_s : -settings_.every_s * std::log(1.0 - unit());
      if (wait(wait_s)) {
        check_end();
      } else if (seconds_since(start_) > settings_.deadline_s) {
        trouble("it did not come to its end in time", launcher_->finish(0.0));
      } else if (!calm) {
        disturb(static_cast<Disturbance>(below(kDisturbances)));
      }
    }
    result_.seconds = seconds_since(start_);
    return result_;
  }

 private:
  double unit() { return random_unit(settings_.seed, Purpose::kChaos, {draws_++}); }
  std::uint64_t below(std::uint64_t count) {
    return random_below(count, settings_.seed, Purpose::kChaos, {draws_++});
  }

  // Whether the launcher has ended by itself before `seconds` were over.
  bool wait(double seconds) {
    const Clock::time_point start = Clock::now();
    while (seconds_since(start) < seconds && seconds_since(start_) <= settings_.deadline_s) {
      if (!launcher_->read_for(std::min(0.2, seconds))) return true;
      if (seconds_since(looked_) < 1.0) continue;
      looked_ = Clock::now();
      look_(footprint_of(all(), settings_.run, seconds_since(start_)));
    }
    return false;
  }

  // The launcher and what it has started.
  std::vector<Process> all() const { return processes_with(settings_.run.string()); }
  // What it has started, of one program or of any.
  std::vector<Process> of(const std::string& program) const {
    std::vector<Process> found;
    for (const Process& process : all()) {
      if (process.pid == launcher_->pid()) continue;
      if (process.command_line.find(program) != std::string::npos) found.push_back(process);
    }
    return found;
  }

  void signal_one(const std::string& program, int signal) {
    const std::vector<Process> victims = of(program);
    if (!victims.empty()) kill(victims[below(victims.size())].pid, signal);
  }
  void signal_all(int signal) {
    launcher_->signal(signal);
    for (const Process& process : all()) kill(process.pid, signal);
  }

  void disturb(Disturbance what) {
    // Before the run's directory is complete there is nothing to resume.
    if (!fs::exists(settings_.run / "manifest.json") || of("corridor-").empty()) return;
    ++count_;
    ++result_.disturbances[what];
    switch (what) {
      case Disturbance::kKillActor:
        return signal_one(kActorProgram, SIGKILL);
      case Disturbance::kKillReplay:
        return signal_one(kReplayProgram, SIGKILL);
      case Disturbance::kKillLearner:
        return signal_one(kLearnerProgram, SIGKILL);
      case Disturbance::kTerminateOne:
        return signal_one("corridor-", SIGTERM);
      case Disturbance::kStopOne:
        return signal_one("corridor-", SIGSTOP);
      case Disturbance::kKillLauncher:
        launcher_->signal(SIGKILL);
        return resume(137);
      case Disturbance::kKillAll:
        signal_all(SIGKILL);
        return resume(137);
      case Disturbance::kTerminate:
        launcher_->signal(SIGTERM);
        return resume(143);
      case Disturbance::kInterrupt:
        launcher_->signal(SIGINT);
        return resume(130);
      case Disturbance::kMachineDown:
        return machine_down();
    }
  }

  void machine_down() {
    signal_all(SIGSTOP);
    const fs::path left = settings_.run.string() + ".left";
    fs::copy(settings_.run, left, fs::copy_options::recursive);
    signal_all(SIGKILL);
    launcher_->finish(kEnds_s);
    fs::remove_all(settings_.run);
    fs::rename(left, settings_.run);
    start_again();
  }

  // The launcher has been made to end with this status, or has come to its end just before.
  void resume(int status) {
    const CommandResult ended = launcher_->finish(kEnds_s);
    if (ended.status == 0) {
      finished_ = true;
      return fingerprint();
    }
    if (ended.status != status) {
      return trouble(fmt::format("status {} instead of {}", ended.status, status), ended);
    }
    start_again();
  }

  void start_again() {
    ++result_.resumes;
    launcher_.emplace(
        std::vector<std::string>{settings_.train.front(), "resume", settings_.run.string()});
  }

  void check_end() {
    const CommandResult ended = launcher_->finish(kEnds_s);
    finished_ = true;
    if (ended.status != 0) return trouble(fmt::format("status {}", ended.status), ended);
    fingerprint();
  }

  void fingerprint() {
    const CommandResult printed = testing_support::run_command(
        {settings_.train.front(), "fingerprint", settings_.run.string()}, 60.0);
    if (printed.status != 0) return trouble("no fingerprint", printed);
    result_.fingerprint = printed.output.substr(0, printed.output.find('\n'));
    const std::vector<Process> left = all();
    if (!left.empty()) trouble("left behind: " + left.front().command_line, printed);
    for (const auto& entry : fs::recursive_directory_iterator(settings_.run)) {
      const std::string name = entry.path().filename();
      if (name.find(".tmp") != std::string::npos || name.ends_with(".partial") ||
          entry.is_socket()) {
        trouble("left behind: " + entry.path().string(), printed);
      }
    }
  }

  void trouble(const std::string& what, const CommandResult& command) {
    result_.trouble = what + "\n" + command.output;
  }

  const ChaosSettings& settings_;
  const std::function<void(const Footprint&)>& look_;
  std::optional<Command> launcher_;
  ChaosResult result_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point looked_ = start_;
  int count_ = 0;
  std::uint64_t draws_ = 0;
  bool finished_ = false;
};

}  // namespace

const char* disturbance_name(Disturbance disturbance) {
  constexpr const char* kNames[] = {"kill an actor",
                                    "kill the replay server",
                                    "kill the learner",
                                    "kill the launcher",
                                    "kill all",
                                    "SIGTERM to one",
                                    "SIGTERM to the launcher",
                                    "Ctrl-C",
                                    "hang one",
                                    "machine down"};
  return kNames[static_cast<int>(disturbance)];
}

ChaosResult train_in_chaos(const ChaosSettings& settings,
                           const std::function<void(const Footprint&)>& look) {
  return Chaos(settings, look).run();
}

}  // namespace corridor::e2e
