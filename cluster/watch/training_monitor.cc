// SPDX-License-Identifier: Apache-2.0
#include "cluster/watch/training_monitor.h"

#include <chrono>

#include "proto/base/failure.h"
#include "proto/run/metrics.h"

namespace corridor::cluster {
namespace {

// Seconds since 1970.
double wall_time_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace

TrainingMonitor::TrainingMonitor(const Schedule& schedule, int actors,
                                 const RunDirectory& directory, std::uint64_t rounds_done,
                                 int cores, double now_s)
    : progress_(schedule, actors, rounds_done, cores, now_s), scalars_(schedule, actors) {
  for (const char* server : {kLearnerName, kReplayName}) {
    sources_.push_back({server, 0, LineTail(directory.metrics(server))});
  }
  for (int i = 0; i < actors; ++i) {
    sources_.push_back(
        {kActorName, static_cast<std::size_t>(i), LineTail(directory.metrics(actor_name(i)))});
  }
  write_events([&] {
    events_.emplace(directory.tensorboard(), wall_time_s());
    go_on_from(rounds_done);
  });
}

void TrainingMonitor::tick(double now_s) {
  for (auto& [process, index, metrics] : sources_) {
    for (const std::string& text : metrics.read()) {
      const auto line = parse_metrics_line(text);
      if (!line) continue;
      progress_.on(process, *line, now_s);
      scalars_.on(process, index, *line);
    }
  }
  const std::vector<StepScalars> ready = scalars_.take();
  write_events([&] {
    for (const StepScalars& at : ready) events_->write(at.step, at.values, wall_time_s());
  });
  display_.show(progress_.lines(), now_s);
}

void TrainingMonitor::restarted(std::uint64_t rounds_done, double now_s) {
  tick(now_s);
  write_events([&] { go_on_from(rounds_done); });
}

void TrainingMonitor::go_on_from(std::uint64_t rounds_done) {
  const std::int64_t steps = scalars_.steps_before(rounds_done);
  scalars_.go_back_to(steps);
  events_->start(steps + 1, wall_time_s());
}

template <typename Action>
void TrainingMonitor::write_events(const Action& action) {
  if (events_given_up_) return;
  try {
    action();
  } catch (const Failure& failure) {
    events_given_up_ = true;
    announce(
        fmt::format("{}; the training goes on without events for TensorBoard", failure.what()));
  }
}

}  // namespace corridor::cluster
