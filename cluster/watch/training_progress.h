// SPDX-License-Identifier: Apache-2.0
// What `corridor train` shows while it waits: the processes' metrics files, read as they grow, in
// a few lines.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "proto/run/metrics.h"
#include "proto/settings/schedule.h"

namespace corridor::cluster {

// What cores do, by name of a part ("simulate", "update", ...); "io" is what ZeroMQ's threads do.
using CoreTime = std::map<std::string, double>;

// How many cores one process keeps busy, by part: its processor time over the line's wall time,
// shared out in proportion to the parts that do not wait (proto/system/time_account.h). Empty when
// the line has no times.
CoreTime cores_by_part(const MetricsValues& values);

// The state of a training as its metrics tell it. Pure: time comes from the caller.
class TrainingProgress {
 public:
  // `rounds_done` before this start (resume); `cores` that all processes share.
  TrainingProgress(const Schedule& schedule, int actors, std::uint64_t rounds_done, int cores,
                   double now_s);

  // A line of kLearnerName, kReplayName or kActorName.
  void on(std::string_view process, const MetricsLine& line, double now_s);

  std::int64_t steps_done() const { return steps_done_; }
  std::vector<std::string> lines() const;

 private:
  // The last values of a name, one at least; those of another phase are dropped.
  struct Recent {
    std::deque<double> values;
    void add(double value);
    double mean() const;
  };
  void advance(const MetricsLine& line, double now_s);
  std::optional<double> mean(const std::string& process, std::string_view name) const;
  // Of the processes of this name together.
  CoreTime cores_of(const std::string& process) const;

  // "BP  [####....]  71.4 %  1,000,000 of 1,400,000 steps  7,012 steps/s  57 s left"
  std::string headline() const;
  // "reward 612, collisions 2.1 per 1000 steps; 32.0 samples per insert"
  std::string details() const;
  // "waits: learner 40 % for actors, actors 3 % for weights; bottleneck: the actors: simulate 81 %,
  // world 9 %". The bottleneck is the cores when they are busy, else the side that others wait for;
  // the parts are where its time goes. Empty while unknown.
  std::string waiting() const;

  Schedule schedule_;
  int actors_;
  int cores_;
  std::string phase_;
  std::int64_t steps_done_ = 0;
  std::deque<std::pair<double, std::int64_t>> history_;  // (time, steps done)
  std::map<std::string, Recent, std::less<>> recent_;    // by "<process> <name>"
};

}  // namespace corridor::cluster
