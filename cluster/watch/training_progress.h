// What `corridor train` shows while it waits: the processes' metrics files, read as they grow, in
// a few lines.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cluster/watch/core_time.h"
#include "proto/run/metrics.h"
#include "proto/settings/schedule.h"

namespace corridor::cluster {

// The state of a training as its metrics tell it. Pure: time comes from the caller.
class TrainingProgress {
 public:
  // `rounds_done` before this start (resume); `cores` that all processes share.
  TrainingProgress(const RunConfig& config, std::uint64_t rounds_done, int cores, double now_s);

  void on_learner(const MetricsLine& line, double now_s);
  void on_actor(const MetricsLine& line);
  void on_replay(const MetricsLine& line);

  std::int64_t steps_done() const { return steps_done_; }
  std::int64_t steps_total() const;
  // Recent environment steps of all actors a second; 0 while unknown.
  double steps_per_s() const;

  // "BP   [####....]  71.4 %  1,000,000 of 1,400,000 steps  7,012 steps/s  57 s left"
  std::string headline() const;
  // "reward 612, collisions 2.1 per 1000 steps; 32.0 samples per insert"
  std::string details() const;
  // "waits: learner 40 % for actors, actors 3 % for weights; bottleneck: the actors: simulate 81 %,
  // world 9 %". The bottleneck is the cores when they are busy, else the side that others wait for;
  // the parts are where its time goes. Empty while unknown.
  std::string waiting() const;
  // All of them that say something.
  std::vector<std::string> lines() const;

 private:
  // The mean of the last values of a name; those of another phase are dropped.
  struct Recent {
    std::deque<double> values;
    void add(double value);
    std::optional<double> mean() const;
  };
  void enter(const std::string& phase);
  void note(const char* process, const MetricsLine& line);
  std::optional<double> mean(const std::string& process, const std::string& name) const;
  // Of the processes of this name together.
  CoreTime cores_of(const std::string& process) const;

  Schedule schedule_;
  int actors_;
  int cores_;
  std::string phase_;
  std::int64_t steps_done_ = 0;
  std::deque<std::pair<double, std::int64_t>> history_;  // (time, steps done)
  std::map<std::string, Recent, std::less<>> recent_;    // by "<process> <name>"
};

}  // namespace corridor::cluster
