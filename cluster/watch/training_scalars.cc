#include "cluster/watch/training_scalars.h"

#include <algorithm>
#include <string_view>

#include "proto/base/failure.h"
#include "proto/run/metrics.h"

namespace corridor::cluster {
namespace {

struct Tag {
  std::string_view process;
  const char* metric;
  const char* group;   // before the phase
  const char* name;    // behind it
  const char* weight;  // the metric that the value is a mean over; may be empty
};
constexpr Tag kTags[] = {
    {"actor", metric::kRewardPer1000, "train", "reward_per_1000_steps", ""},
    {"actor", metric::kCollisionsPer1000, "train", "collisions_per_1000_steps", ""},
    {"actor", metric::kEpisodicReturn, "train", "reward_per_episode", metric::kEpisodes},
    {"actor", metric::kEpsilon, "train", "epsilon", ""},
    {"learner", metric::kTdLoss, "train", "loss", ""},
    {"learner", metric::kQValues, "train", "q", ""},
    {"learner", metric::kRiskValues, "train", "risk", ""},
    {"learner", metric::kLearningRate, "train", "learning_rate", ""},
    {"learner", metric::kStepsPerS, "train", "steps_per_second", ""},
    {"learner", metric::kGreedyRewardPer1000, "selection", "reward_per_1000_steps", ""},
    {"learner", metric::kGreedyCollisionsPer1000, "selection", "collisions_per_1000_steps", ""},
    {"learner", metric::kGreedyScore, "selection", "score", ""},
    {"replay", metric::kSamplesPerInsert, "train", "replay_ratio", ""},
    {"replay", metric::kReplaySize, "train", "replay_size", ""},
};

std::string full_name(const Tag& tag, const std::string& phase) {
  const auto network = std::ranges::find(kNetworks, phase, &NamedNetwork::phase_name);
  return fmt::format("{}/{}/{}", tag.group, network == kNetworks.end() ? phase : network->name,
                     tag.name);
}

}  // namespace

TrainingScalars::TrainingScalars(const Schedule& schedule, int actors)
    : steps_per_round_(schedule.steps_per_round()),
      actors_reached_(static_cast<std::size_t>(actors)) {}

std::int64_t TrainingScalars::steps_before(std::uint64_t round) const {
  return static_cast<std::int64_t>(round) * steps_per_round_;
}

void TrainingScalars::on_actor(int actor, const MetricsLine& line) {
  const std::int64_t step = steps_before(line.round + 1);
  std::int64_t& reached = actors_reached_.at(static_cast<std::size_t>(actor));
  // Started again, it says what it said before.
  if (step <= reached) return;
  reached = step;
  if (step <= actors_last_) return;
  auto& sums = waiting_[step];
  for (const Tag& tag : kTags) {
    const auto value = line.values.find(tag.metric);
    if (tag.process != "actor" || value == line.values.end()) continue;
    const double weight = *tag.weight == '\0' ? 1.0 : value_of(line.values, tag.weight);
    if (weight <= 0.0) continue;
    Sum& sum = sums[full_name(tag, line.phase)];
    sum.value += weight * value->second;
    sum.weight += weight;
  }
  const std::int64_t all = *std::ranges::min_element(actors_reached_);
  while (!waiting_.empty() && waiting_.begin()->first <= all) {
    StepScalars scalars{waiting_.begin()->first, {}};
    for (const auto& [tag, sum] : waiting_.begin()->second) {
      scalars.values.emplace_back(tag, sum.value / sum.weight);
    }
    actors_last_ = scalars.step;
    ready_.push_back(std::move(scalars));
    waiting_.erase(waiting_.begin());
  }
}

void TrainingScalars::on_learner(const MetricsLine& line) {
  give_on(line, "learner", learner_last_);
}

void TrainingScalars::on_replay(const MetricsLine& line) { give_on(line, "replay", replay_last_); }

void TrainingScalars::give_on(const MetricsLine& line, const char* process, std::int64_t& last) {
  StepScalars scalars{steps_before(line.round + 1), {}};
  if (scalars.step <= last) return;
  last = scalars.step;
  for (const Tag& tag : kTags) {
    const auto value = line.values.find(tag.metric);
    if (tag.process == process && value != line.values.end()) {
      scalars.values.emplace_back(full_name(tag, line.phase), value->second);
    }
  }
  if (!scalars.values.empty()) ready_.push_back(std::move(scalars));
}

std::vector<StepScalars> TrainingScalars::take() { return std::exchange(ready_, {}); }

void TrainingScalars::go_back_to(std::int64_t step) {
  waiting_.clear();
  for (std::int64_t& reached : actors_reached_) reached = std::min(reached, step);
  for (std::int64_t* last : {&actors_last_, &learner_last_, &replay_last_}) {
    *last = std::min(*last, step);
  }
}

}  // namespace corridor::cluster
