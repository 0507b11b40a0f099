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

#include "cluster/core_time.h"
#include "proto/schedule.h"

namespace corridor::cluster {

// One line of a metrics file (proto/metrics.h).
struct MetricsLine {
  std::string phase;
  std::uint64_t round = 0;
  std::int64_t step = 0;
  MetricsValues values;  // all other numbers by name
};

// Nothing when the text is no such line.
std::optional<MetricsLine> parse_metrics_line(std::string_view text);

// The last whole line of a metrics file; nothing when the file is missing or has none.
std::optional<MetricsLine> last_metrics_line(const std::filesystem::path& file);

// The steps driven so far, of a line "steps/total" of an evaluating actor; nothing when the text is
// no such line.
std::optional<std::int64_t> parse_step_count(std::string_view text);

// What is appended to a text file, line by line. The file may come later.
class LineTail {
 public:
  // Begins at the file's present end.
  explicit LineTail(std::filesystem::path file);

  // The whole lines since the last call; a line without its end yet waits for the next call. At
  // most 4 MiB a call, the rest follows.
  std::vector<std::string> read();

 private:
  std::filesystem::path file_;
  std::uintmax_t offset_ = 0;
};

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
  std::optional<double> mean(const std::string& process, const char* name) const;
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

// Where progress goes: on a terminal the lines are written over again, in a pipe or file they
// follow each other, every ten seconds.
class ProgressDisplay {
 public:
  // Looks at standard output.
  ProgressDisplay();
  // Leaves the last lines standing.
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  // Whether something shown now would be seen: saves the caller the work.
  bool due(double now_s) const;
  void show(const std::vector<std::string>& lines, double now_s);
  // A line that stays, above what is shown from now on.
  void announce(const std::string& line);

 private:
  bool terminal_;
  std::size_t shown_ = 0;  // lines standing on the terminal
  std::optional<double> last_s_;
};

// Seconds of a clock that only goes forward.
double monotonic_s();

// "[#####.....]": `done` in [0, 1].
std::string progress_bar(double done, int width);

}  // namespace corridor::cluster
