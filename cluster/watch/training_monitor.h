// SPDX-License-Identifier: Apache-2.0
// What people see of a training while it goes on: its processes' metrics files, read as they grow,
// as progress on standard output and as events for TensorBoard.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cluster/watch/display.h"
#include "cluster/watch/line_tail.h"
#include "cluster/watch/tensorboard.h"
#include "cluster/watch/training_progress.h"
#include "cluster/watch/training_scalars.h"
#include "proto/run/run_directory.h"
#include "proto/settings/schedule.h"

namespace corridor::cluster {

// No training ends because its events cannot be written: that is announced, and given up. Times are
// of monotonic_s().
class TrainingMonitor {
 public:
  // `rounds_done` before this start; `cores` that all processes share.
  TrainingMonitor(const Schedule& schedule, int actors, const RunDirectory& directory,
                  std::uint64_t rounds_done, int cores, double now_s);

  // Reads on.
  void tick(double now_s);
  // A line that stays.
  void announce(const std::string& line) { display_.announce(line); }
  // All processes have ended, and others go on after so many rounds.
  void restarted(std::uint64_t rounds_done, double now_s);
  // Of both phases, all actors together.
  std::int64_t steps_done() const { return progress_.steps_done(); }

 private:
  struct Source {
    const char* process;  // kLearnerName, kReplayName, kActorName
    std::size_t index;    // of those
    LineTail metrics;
  };
  template <typename Action>
  void write_events(const Action& action);
  void go_on_from(std::uint64_t rounds_done);

  TrainingProgress progress_;
  TrainingScalars scalars_;
  std::vector<Source> sources_;
  std::optional<EventWriter> events_;
  bool events_given_up_ = false;
  ProgressDisplay display_;
};

}  // namespace corridor::cluster
