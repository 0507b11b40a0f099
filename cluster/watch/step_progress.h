// SPDX-License-Identifier: Apache-2.0
// Progress of many processes that drive steps, each known by a file that grows: one bar for all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cluster/watch/display.h"
#include "cluster/watch/line_tail.h"

namespace corridor::cluster {

struct StepTask {
  std::string name;
  std::int64_t steps = 0;
  std::int64_t done = 0;       // before this start
  std::filesystem::path file;  // that the process appends to
  // How many steps are done, from one of its lines; nothing when the line does not say.
  std::function<std::optional<std::int64_t>(std::string_view line)> steps_done;
};

// Time comes from the caller.
class StepProgress {
 public:
  // `unit`: what is counted, if not steps. `out` outlives it.
  StepProgress(std::string title, std::vector<StepTask> tasks, double now_s,
               std::string unit = "steps", std::FILE* out = stdout);

  // Reads what is new and shows it.
  void tick(double now_s);

  // "evaluation [###....]  43.1 %  51,724 of 120,000 steps  7,012 steps/s  10 s left"
  // "1 of 3 done, rules 1002: 43 %"
  std::vector<std::string> lines(double now_s) const;

 private:
  struct Task {
    StepTask task;
    LineTail tail;
  };
  std::string title_;
  std::string unit_;
  std::vector<Task> tasks_;
  double start_s_;
  std::int64_t done_at_start_ = 0;
  ProgressDisplay display_;
};

}  // namespace corridor::cluster
