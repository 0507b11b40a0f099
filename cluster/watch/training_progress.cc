// SPDX-License-Identifier: Apache-2.0
#include "cluster/watch/training_progress.h"

#include <algorithm>

#include "cluster/watch/display.h"
#include "proto/base/format.h"
#include "proto/run/run_directory.h"
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

double sum(const CoreTime& parts) {
  double total = 0.0;
  for (const auto& [part, value] : parts) total += value;
  return total;
}

// "simulate 52 %, update 25 %, world 8 %": the largest parts as shares of the sum.
std::string largest_parts(const CoreTime& parts) {
  int count = kPartsNamed;
  std::vector<std::pair<double, std::string>> sorted;
  for (const auto& [part, value] : parts) sorted.emplace_back(-value, part);
  std::sort(sorted.begin(), sorted.end());
  const double total = sum(parts);
  std::string text;
  for (const auto& [negative, part] : sorted) {
    if (count-- == 0 || total <= 0.0) break;
    text += fmt::format("{}{} {:.0f} %", text.empty() ? "" : ", ", part, -100.0 * negative / total);
  }
  return text;
}

}  // namespace

CoreTime cores_by_part(const MetricsValues& values) {
  const double wall_s = value_of(values, kWallTimeMetric);
  if (wall_s <= 0.0) return {};
  CoreTime parts;
  double busy = 0.0;
  for (std::size_t i = 0; i < kTimeParts; ++i) {
    const auto part = static_cast<TimePart>(i);
    const auto found = values.find(time_metric(part));
    if (is_wait(part) || found == values.end()) continue;
    parts[time_part_name(part)] = found->second;
    busy += found->second;
  }
  const double cores = value_of(values, kCpuTimeMetric) / wall_s;
  for (auto& [part, share] : parts) share *= busy > 0.0 ? cores / busy : 0.0;
  parts["io"] = value_of(values, kIoCpuTimeMetric) / wall_s;
  return parts;
}

void TrainingProgress::Recent::add(double value) {
  values.push_back(value);
  if (values.size() > kRecentLines) values.pop_front();
}

double TrainingProgress::Recent::mean() const {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

TrainingProgress::TrainingProgress(const Schedule& schedule, int actors, std::uint64_t rounds_done,
                                   int cores, double now_s)
    : schedule_(schedule),
      actors_(actors),
      cores_(cores),
      phase_(phase_name(schedule_.phase_of(std::min(rounds_done, schedule_.rounds() - 1)))),
      steps_done_(static_cast<std::int64_t>(rounds_done) * schedule_.steps_per_round()) {
  history_.emplace_back(now_s, steps_done_);
}

void TrainingProgress::on(std::string_view process, const MetricsLine& line, double now_s) {
  // Actors are a round ahead of the learner at most: it says which phase it is.
  if (process == kLearnerName) {
    advance(line, now_s);
  } else if (line.phase != phase_) {
    return;
  }
  for (const auto& [name, value] : line.values) {
    recent_[fmt::format("{} {}", process, name)].add(value);
  }
}

void TrainingProgress::advance(const MetricsLine& line, double now_s) {
  if (line.phase != phase_) recent_.clear();
  phase_ = line.phase;
  if (line.round >= schedule_.rounds()) return;  // of another configuration
  steps_done_ = static_cast<std::int64_t>(line.round + 1) * schedule_.steps_per_round();
  if (steps_done_ < history_.back().second) history_.clear();  // gone back to a checkpoint
  history_.emplace_back(now_s, steps_done_);
  while (history_.size() > 2 && history_[1].first < now_s - kRateWindow_s) history_.pop_front();
}

std::optional<double> TrainingProgress::mean(const std::string& process,
                                             std::string_view name) const {
  const auto found = recent_.find(fmt::format("{} {}", process, name));
  return found == recent_.end() ? std::nullopt : std::optional(found->second.mean());
}

std::string TrainingProgress::headline() const {
  const double passed_s = history_.back().first - history_.front().first;
  const auto steps = static_cast<double>(history_.back().second - history_.front().second);
  return progress_line(fmt::format("{:<4}", phase_), steps_done_,
                       static_cast<std::int64_t>(schedule_.rounds()) * schedule_.steps_per_round(),
                       "steps", passed_s > 0.0 ? steps / passed_s : 0.0);
}

std::string TrainingProgress::details() const {
  std::string text;
  const auto append = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  if (const auto reward = mean(kActorName, metric::kRewardPer1000)) {
    append(fmt::format("reward {:.0f}, collisions {:.1f} per 1000 steps", *reward,
                       mean(kActorName, metric::kCollisionsPer1000).value_or(0.0)));
  }
  if (const auto ratio = mean(kReplayName, metric::kSamplesPerInsert)) {
    append(fmt::format("{:.1f} samples per insert", *ratio));
  }
  return text.empty() ? "starting" : text;
}

CoreTime TrainingProgress::cores_of(const std::string& process) const {
  MetricsValues means;
  for (const auto& [name, recent] : recent_) {
    if (name.starts_with(process + " ")) means[name.substr(process.size() + 1)] = recent.mean();
  }
  CoreTime parts = cores_by_part(means);
  if (process == kActorName) {
    for (auto& [part, cores] : parts) cores *= actors_;
  }
  return parts;
}

// Who waits for whom, what the cores do, and so what is the bottleneck.
std::string TrainingProgress::waiting() const {
  const auto for_actors = mean(kLearnerName, time_metric(TimePart::kWaitForActors));
  const auto for_weights = mean(kActorName, time_metric(TimePart::kWaitForLearner));
  if (!for_actors || !for_weights) return "";
  const double learner_for_replay =
      mean(kLearnerName, time_metric(TimePart::kWaitForReplay)).value_or(0.0);
  const double actors_for_replay =
      mean(kActorName, time_metric(TimePart::kWaitForReplay)).value_or(0.0);
  const double for_replay = std::max(learner_for_replay, actors_for_replay);

  const CoreTime of_actors = cores_of(kActorName);
  const CoreTime of_learner = cores_of(kLearnerName);
  const CoreTime of_replay = cores_of(kReplayName);
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
  const Side& most = *std::ranges::max_element(sides, {}, &Side::waited_for);
  const auto described = [](const std::string& name, const CoreTime& parts) {
    return parts.empty() ? name : name + ": " + largest_parts(parts);
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
