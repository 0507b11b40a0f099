// SPDX-License-Identifier: Apache-2.0
// Where a process's time goes: every moment of its main thread belongs to one part. Always on: a
// charge is one look at the clock, about 25 ns. One thread. `now`: for tests.
#pragma once

#include <array>
#include <cstddef>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

#include "proto/system/clock.h"
#include "proto/system/pulse.h"

namespace corridor {

// The parts of all processes. Those that wait are not work; the scheduler may also take the core
// away in any other part, so that shares, not seconds, are what to compare.
enum class TimePart {
  kSimulate,        // actor: SUMO's own step
  kTraffic,         // actor: vehicles enter and leave SUMO, or go blind
  kWorld,           // actor: placing the ego, reading the vehicles, collisions
  kLoad,            // actor: SUMO loads an episode
  kPlan,            // actor: gaps, windows, observations, trajectories, rewards, transitions
  kInfer,           // actor: forward passes
  kInsert,          // replay: chunks into the store
  kSample,          // replay: priorities in, batches out
  kUpdate,          // learner: forward, backward, optimiser
  kPublish,         // learner: weights to actors, their outcomes
  kCheckpoint,      // learner and replay
  kTransport,       // all: values to bytes and back, sending and receiving
  kWaitForActors,   // replay, learner
  kWaitForReplay,   // actor, learner
  kWaitForLearner,  // actor: for weights; replay: for requests
};
inline constexpr std::size_t kTimeParts = 15;

// "simulate", "wait_for_replay".
const char* time_part_name(TimePart part);

// What a process writes of its times, over a stretch of wall time (proto/run/metrics.h).
std::string time_metric(TimePart part);  // "time/<part>": its share
inline constexpr const char* kWallTimeMetric = "time/wall_s";
inline constexpr const char* kCpuTimeMetric = "time/cpu_s";          // of the main thread
inline constexpr const char* kIoCpuTimeMetric = "time/cpu_of_io_s";  // of all others, ZeroMQ's

inline bool is_wait(TimePart part) { return part >= TimePart::kWaitForActors; }

class TimeAccount {
 public:
  explicit TimeAccount(TimePoint now = steady_now()) : mark_(now), taken_(now) {}

  // What was passed since the last charge, or since the start, was spent on this part.
  void charge(TimePart part, TimePoint now = steady_now()) {
    spent_[static_cast<std::size_t>(part)] += now - std::exchange(mark_, now);
    beat();
  }

  // Since the last `take`, or since the start.
  double wall_s(TimePoint now = steady_now()) const { return in_seconds(now - taken_); }

  // Over wall_s(): the share of every part that was ever charged, the wall time, and the processor
  // time of the calling thread and of all others.
  std::vector<std::pair<std::string, double>> take(TimePoint now = steady_now());

 private:
  TimePoint mark_;
  TimePoint taken_;
  double thread_cpu_s_ = 0.0;
  double process_cpu_s_ = 0.0;
  std::array<TimePoint::duration, kTimeParts> spent_{};
  std::array<bool, kTimeParts> known_{};
};

}  // namespace corridor
