// SPDX-License-Identifier: Apache-2.0
#include "cluster/watch/step_progress.h"

#include <algorithm>

#include "proto/base/format.h"

namespace corridor::cluster {

StepProgress::StepProgress(std::string title, std::vector<StepTask> tasks, double now_s,
                           std::string unit, std::FILE* out)
    : title_(std::move(title)), unit_(std::move(unit)), start_s_(now_s), display_(out) {
  for (StepTask& task : tasks) {
    done_at_start_ += task.done;
    LineTail tail(task.file);
    tasks_.push_back({std::move(task), std::move(tail)});
  }
}

void StepProgress::tick(double now_s) {
  for (auto& [task, tail] : tasks_) {
    for (const std::string& line : tail.read()) {
      if (const auto done = task.steps_done(line)) task.done = std::min(*done, task.steps);
    }
  }
  display_.show(lines(now_s), now_s);
}

std::vector<std::string> StepProgress::lines(double now_s) const {
  std::int64_t done = 0, total = 0;
  std::size_t complete = 0;
  std::string running;
  for (const auto& [task, tail] : tasks_) {
    done += task.done;
    total += task.steps;
    complete += task.done >= task.steps;
    if (task.done == 0 || task.done >= task.steps) continue;
    running +=
        fmt::format(", {}: {:.0f} %", task.name,
                    100.0 * static_cast<double>(task.done) / static_cast<double>(task.steps));
  }
  const double passed_s = now_s - start_s_;
  const double rate = passed_s > 0.0 ? static_cast<double>(done - done_at_start_) / passed_s : 0.0;
  return {progress_line(title_ + " ", done, total, unit_, rate),
          fmt::format("{} of {} done{}", complete, tasks_.size(), running)};
}

}  // namespace corridor::cluster
