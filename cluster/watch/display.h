// SPDX-License-Identifier: Apache-2.0
// Where progress for people goes.
#pragma once

#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

namespace corridor::cluster {

// On a terminal the lines are written over again; in a pipe or file, and on a terminal that knows
// no control sequences (TERM=dumb), they follow each other, every ten seconds. Nothing is thrown
// where they cannot be written.
class ProgressDisplay {
 public:
  // `out` outlives it.
  explicit ProgressDisplay(std::FILE* out = stdout);
  // Leaves the last lines standing.
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  void show(const std::vector<std::string>& lines, double now_s);
  // A line that stays, above what is shown from now on.
  void announce(const std::string& line);

 private:
  void clear();

  std::FILE* out_;
  bool terminal_;
  std::size_t shown_ = 0;  // lines standing on the terminal
  std::optional<double> last_s_;
};

// "BP  [####....]  71.4 %  1,000,000 of 1,400,000 steps  7,012 steps/s  57 s left"; what follows
// from the speed only where that is more than 0.
std::string progress_line(const std::string& title, std::int64_t done, std::int64_t total,
                          const std::string& unit, double per_s);

}  // namespace corridor::cluster
