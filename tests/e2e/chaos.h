// SPDX-License-Identifier: Apache-2.0
// A training that is disturbed at random, again and again, and must end with the bits of one that
// was not. What happens when is drawn from a seed; where a process then stands is chance.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace corridor::e2e {

// What may happen to a run.
enum class Disturbance {
  kKillActor,
  kKillReplay,
  kKillLearner,
  kKillLauncher,  // then `corridor resume`
  kKillAll,       // then resume
  kTerminateOne,  // SIGTERM to any process but the launcher
  kTerminate,     // SIGTERM to the launcher, then resume
  kInterrupt,     // Ctrl-C, then resume
  kStopOne,       // SIGSTOP: it hangs
  kMachineDown,   // all stop at once; what is on disk then is all that is left; then resume
};
inline constexpr int kDisturbances = 10;
const char* disturbance_name(Disturbance disturbance);

struct ChaosSettings {
  std::vector<std::string> train;  // the command of a training, but for its --run
  std::filesystem::path run;       // made by it
  std::uint64_t seed = 1;
  double every_s = 2.0;       // mean time between disturbances
  int most = 50;              // disturbances; then it is left in peace
  double deadline_s = 600.0;  // of the whole
};

// What the processes of the run take together, at one time.
struct Footprint {
  double time_s = 0.0;
  int processes = 0;
  double memory_mb = 0.0;  // resident
  int descriptors = 0;
  double disk_mb = 0.0;  // of the run directory; what is linked twice counts once
};

struct ChaosResult {
  std::map<Disturbance, int> disturbances;
  int resumes = 0;
  double seconds = 0.0;
  std::string fingerprint;  // empty when it did not come to its end
  std::string trouble;      // what went wrong, if anything did; with the output
};

// `look` is called about once a second.
ChaosResult train_in_chaos(const ChaosSettings& settings,
                           const std::function<void(const Footprint&)>& look);

}  // namespace corridor::e2e
