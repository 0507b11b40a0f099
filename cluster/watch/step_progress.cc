#include "cluster/watch/step_progress.h"

#include <algorithm>
#include <cmath>

#include "proto/base/format.h"
#include "proto/base/text.h"

namespace corridor::cluster {

StepProgress::StepProgress(std::string title, std::vector<StepTask> tasks, double now_s,
                           std::string unit)
    : title_(std::move(title)), unit_(std::move(unit)), start_s_(now_s) {
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
  if (display_.due(now_s)) display_.show({headline(now_s), details()}, now_s);
}

std::string StepProgress::headline(double now_s) const {
  std::int64_t done = 0, total = 0;
  for (const auto& [task, tail] : tasks_) {
    done += task.done;
    total += task.steps;
  }
  const double share = total > 0 ? static_cast<double>(done) / static_cast<double>(total) : 1.0;
  std::string text = fmt::format("{} {} {:5.1f} %  {} of {} {}", title_, progress_bar(share, 20),
                                 100.0 * share, grouped(done), grouped(total), unit_);
  if (done > done_at_start_ && now_s > start_s_) {
    const double rate = static_cast<double>(done - done_at_start_) / (now_s - start_s_);
    text += fmt::format("  {} {}/s  {} left", grouped(std::llround(rate)), unit_,
                        duration_text(static_cast<double>(total - done) / rate));
  }
  return text;
}

std::string StepProgress::details() const {
  std::size_t complete = 0;
  std::string running;
  for (const auto& [task, tail] : tasks_) {
    complete += task.done >= task.steps;
    if (task.done == 0 || task.done >= task.steps) continue;
    running +=
        fmt::format(", {}: {:.0f} %", task.name,
                    100.0 * static_cast<double>(task.done) / static_cast<double>(task.steps));
  }
  return fmt::format("{} of {} done{}", complete, tasks_.size(), running);
}

}  // namespace corridor::cluster
