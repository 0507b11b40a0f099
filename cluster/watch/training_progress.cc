#include "cluster/watch/training_progress.h"

#include <algorithm>
#include <cmath>

#include "cluster/watch/display.h"
#include "proto/base/failure.h"
#include "proto/base/text.h"
#include "proto/run/metrics.h"
#include "proto/system/time_account.h"

namespace corridor::cluster {
namespace {

constexpr double kRateWindow_s = 30.0;
// An actor writes a line for about 4000 steps of all actors.
constexpr std::size_t kRecentLines = 20;
// From this share of its time on, waiting is worth naming.
constexpr double kWaitsMuch = 0.1;
// From this share on, more processes would only wait for the cores.
constexpr double kCoresBusy = 0.9;
constexpr int kPartsNamed = 3;

std::string percent(double share) { return fmt::format("{:.0f} %", 100.0 * share); }

}  // namespace

void TrainingProgress::Recent::add(double value) {
  values.push_back(value);
  if (values.size() > kRecentLines) values.pop_front();
}

std::optional<double> TrainingProgress::Recent::mean() const {
  if (values.empty()) return std::nullopt;
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

TrainingProgress::TrainingProgress(const RunConfig& config, std::uint64_t rounds_done, int cores,
                                   double now_s)
    : schedule_(config),
      actors_(config.run.actors),
      cores_(cores),
      phase_(phase_name(schedule_.phase_of(std::min(rounds_done, schedule_.rounds() - 1)))),
      steps_done_(static_cast<std::int64_t>(rounds_done) * schedule_.steps_per_round()) {
  history_.emplace_back(now_s, steps_done_);
}

std::int64_t TrainingProgress::steps_total() const {
  return static_cast<std::int64_t>(schedule_.rounds()) * schedule_.steps_per_round();
}

void TrainingProgress::enter(const std::string& phase) {
  if (phase == phase_) return;
  phase_ = phase;
  recent_.clear();
}

void TrainingProgress::note(const char* process, const MetricsLine& line) {
  for (const auto& [name, value] : line.values) {
    recent_[fmt::format("{} {}", process, name)].add(value);
  }
}

void TrainingProgress::on_learner(const MetricsLine& line, double now_s) {
  enter(line.phase);
  note("learner", line);
  if (line.round >= schedule_.rounds()) return;  // of another configuration
  steps_done_ = static_cast<std::int64_t>(line.round + 1) * schedule_.steps_per_round();
  if (steps_done_ < history_.back().second) history_.clear();  // gone back to a checkpoint
  history_.emplace_back(now_s, steps_done_);
  while (history_.size() > 2 && history_[1].first < now_s - kRateWindow_s) history_.pop_front();
}

void TrainingProgress::on_actor(const MetricsLine& line) {
  // Actors are a round ahead of the learner at most: it says which phase it is.
  if (line.phase == phase_) note("actor", line);
}

void TrainingProgress::on_replay(const MetricsLine& line) {
  if (line.phase == phase_) note("replay", line);
}

std::optional<double> TrainingProgress::mean(const std::string& process,
                                             const std::string& name) const {
  const auto found = recent_.find(fmt::format("{} {}", process, name));
  return found == recent_.end() ? std::nullopt : found->second.mean();
}

double TrainingProgress::steps_per_s() const {
  const double passed_s = history_.back().first - history_.front().first;
  const auto steps = static_cast<double>(history_.back().second - history_.front().second);
  return passed_s > 0.0 ? steps / passed_s : 0.0;
}

std::string TrainingProgress::headline() const {
  const double share = static_cast<double>(steps_done_) / static_cast<double>(steps_total());
  const double rate = steps_per_s();
  std::string text =
      fmt::format("{:<4}{} {:5.1f} %  {} of {} steps", phase_, progress_bar(share, 20),
                  100.0 * share, grouped(steps_done_), grouped(steps_total()));
  if (rate > 0.0) {
    text += fmt::format("  {} steps/s  {} left", grouped(std::llround(rate)),
                        duration_text(static_cast<double>(steps_total() - steps_done_) / rate));
  }
  return text;
}

std::string TrainingProgress::details() const {
  std::string text;
  const auto append = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  if (const auto reward = mean("actor", metric::kRewardPer1000)) {
    append(fmt::format("reward {:.0f}, collisions {:.1f} per 1000 steps", *reward,
                       mean("actor", metric::kCollisionsPer1000).value_or(0.0)));
  }
  if (const auto ratio = mean("replay", metric::kSamplesPerInsert)) {
    append(fmt::format("{:.1f} samples per insert", *ratio));
  }
  return text.empty() ? "starting" : text;
}

CoreTime TrainingProgress::cores_of(const std::string& process) const {
  MetricsValues means;
  for (const auto& [name, recent] : recent_) {
    if (!name.starts_with(process + " time/")) continue;
    if (const auto value = recent.mean()) means[name.substr(process.size() + 1)] = *value;
  }
  CoreTime parts = cores_by_part(means);
  if (process == "actor") {
    for (auto& [part, cores] : parts) cores *= actors_;
  }
  return parts;
}

// Who waits for whom, what the cores do, and so what is the bottleneck.
std::string TrainingProgress::waiting() const {
  const auto for_actors = mean("learner", time_metric(TimePart::kWaitForActors));
  const auto for_weights = mean("actor", time_metric(TimePart::kWaitForLearner));
  if (!for_actors || !for_weights) return "";
  const double learner_for_replay =
      mean("learner", time_metric(TimePart::kWaitForReplay)).value_or(0.0);
  const double actors_for_replay =
      mean("actor", time_metric(TimePart::kWaitForReplay)).value_or(0.0);
  const double for_replay = std::max(learner_for_replay, actors_for_replay);

  const CoreTime of_actors = cores_of("actor");
  const CoreTime of_learner = cores_of("learner");
  const CoreTime of_replay = cores_of("replay");
  CoreTime of_all;
  for (const CoreTime* parts : {&of_actors, &of_learner, &of_replay}) {
    for (const auto& [part, cores] : *parts) of_all[part] += cores;
  }
  const double busy = sum(of_all) / cores_;

  struct Side {
    double waited_for;  // by the others
    std::string name;
    const CoreTime& parts;
  };
  const Side sides[] = {{for_replay, "the replay server", of_replay},
                        {*for_weights, "the learner", of_learner},
                        {*for_actors, "the actors", of_actors}};
  const Side most =
      *std::max_element(std::begin(sides), std::end(sides),
                        [](const Side& a, const Side& b) { return a.waited_for < b.waited_for; });
  const auto described = [](const std::string& name, const CoreTime& parts) {
    return parts.empty() ? name : name + ": " + largest_parts(parts, kPartsNamed);
  };
  std::string bottleneck = "none";
  if (busy >= kCoresBusy) {
    bottleneck = described(fmt::format("the {} cores", cores_), of_all);
  } else if (most.waited_for >= kWaitsMuch) {
    bottleneck = described(most.name, most.parts);
  }
  std::string text = fmt::format("waits: learner {} for actors, actors {} for weights",
                                 percent(*for_actors), percent(*for_weights));
  if (for_replay >= kWaitsMuch) {
    text += fmt::format(", learner {} and actors {} for replay", percent(learner_for_replay),
                        percent(actors_for_replay));
  }
  return fmt::format("{}; bottleneck: {}", text, bottleneck);
}

std::vector<std::string> TrainingProgress::lines() const {
  std::vector<std::string> result = {headline(), details()};
  if (std::string waits = waiting(); !waits.empty()) result.push_back(std::move(waits));
  return result;
}

}  // namespace corridor::cluster
