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

template <typename Action>
void for_lines(LineTail& tail, const Action& action) {
  for (const std::string& text : tail.read()) {
    if (const auto line = parse_metrics_line(text)) action(*line);
  }
}

}  // namespace

TrainingMonitor::TrainingMonitor(const Schedule& schedule, int actors,
                                 const RunDirectory& directory, std::uint64_t rounds_done,
                                 int cores, double now_s)
    : progress_(schedule, actors, rounds_done, cores, now_s),
      scalars_(schedule, actors),
      learner_(directory.metrics(kLearnerName)),
      replay_(directory.metrics(kReplayName)) {
  for (int i = 0; i < actors; ++i) actors_.emplace_back(directory.metrics(actor_name(i)));
  write_events([&] {
    events_.emplace(directory.tensorboard(), wall_time_s());
    go_on_from(rounds_done);
  });
}

void TrainingMonitor::tick(double now_s) {
  for_lines(learner_, [&](const MetricsLine& line) {
    progress_.on_learner(line, now_s);
    scalars_.on_learner(line);
  });
  for_lines(replay_, [&](const MetricsLine& line) {
    progress_.on_replay(line);
    scalars_.on_replay(line);
  });
  for (std::size_t i = 0; i < actors_.size(); ++i) {
    for_lines(actors_[i], [&](const MetricsLine& line) {
      progress_.on_actor(line);
      scalars_.on_actor(static_cast<int>(i), line);
    });
  }
  const std::vector<StepScalars> ready = scalars_.take();
  write_events([&] {
    for (const StepScalars& at : ready) events_->write(at.step, at.values, wall_time_s());
  });
  if (display_.due(now_s)) display_.show(progress_.lines(), now_s);
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
