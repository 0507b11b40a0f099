// Where progress for people goes.
#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

namespace corridor::cluster {

// On a terminal the lines are written over again, in a pipe or file they follow each other, every
// ten seconds.
class ProgressDisplay {
 public:
  // `out` outlives it.
  explicit ProgressDisplay(std::FILE* out = stdout);
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
  void clear();

  std::FILE* out_;
  bool terminal_;
  std::size_t shown_ = 0;  // lines standing on the terminal
  std::optional<double> last_s_;
};

// "[#####.....]": `done` in [0, 1].
std::string progress_bar(double done, int width);

}  // namespace corridor::cluster
