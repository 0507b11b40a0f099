// SPDX-License-Identifier: Apache-2.0
#include "cluster/watch/training_scalars.h"

#include <algorithm>

#include "proto/base/format.h"
#include "proto/run/run_directory.h"

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
    {kActorName, metric::kCollisionsPer1000, "train", "collisions_per_1000_steps", ""},
    {kActorName, metric::kEpsilon, "train", "epsilon", ""},
    {kActorName, metric::kRewardPer1000, "train", "reward_per_1000_steps", ""},
    {kActorName, metric::kEpisodicReturn, "train", "reward_per_episode", metric::kEpisodes},
    {kLearnerName, metric::kTdLoss, "train", "loss", ""},
    {kLearnerName, metric::kQValues, "train", "q", ""},
    {kLearnerName, metric::kRiskValues, "train", "risk", ""},
    {kLearnerName, metric::kLearningRate, "train", "learning_rate", ""},
    {kLearnerName, metric::kStepsPerS, "train", "steps_per_second", ""},
    {kLearnerName, metric::kGreedyRewardPer1000, "selection", "reward_per_1000_steps", ""},
    {kLearnerName, metric::kGreedyCollisionsPer1000, "selection", "collisions_per_1000_steps", ""},
    {kLearnerName, metric::kGreedyScore, "selection", "score", ""},
    {kReplayName, metric::kSamplesPerInsert, "train", "replay_ratio", ""},
    {kReplayName, metric::kReplaySize, "train", "replay_size", ""},
};

std::string full_name(const Tag& tag, const std::string& phase) {
  const auto network = std::ranges::find(kNetworks, phase, &NamedNetwork::phase_name);
  return fmt::format("{}/{}/{}", tag.group, network == kNetworks.end() ? phase : network->name,
                     tag.name);
}

}  // namespace

TrainingScalars::TrainingScalars(const Schedule& schedule, int actors)
    : steps_per_round_(schedule.steps_per_round()) {
  for (const char* server : {kLearnerName, kReplayName}) groups_[server].reached.resize(1);
  groups_[kActorName].reached.resize(static_cast<std::size_t>(actors));
}

std::int64_t TrainingScalars::steps_before(std::uint64_t round) const {
  return static_cast<std::int64_t>(round) * steps_per_round_;
}

void TrainingScalars::on(std::string_view process, std::size_t index, const MetricsLine& line) {
  Group& group = groups_.find(process)->second;
  const std::int64_t step = steps_before(line.round + 1);
  std::int64_t& reached = group.reached.at(index);
  // Started again, it says what it said before.
  if (step <= reached) return;
  reached = step;
  if (step <= group.given_on) return;
  std::vector<Sum>& sums = group.waiting.try_emplace(step, std::size(kTags)).first->second;
  for (std::size_t i = 0; i < std::size(kTags); ++i) {
    const Tag& tag = kTags[i];
    const auto value = line.values.find(tag.metric);
    if (tag.process != process || value == line.values.end()) continue;
    const double weight = *tag.weight == '\0' ? 1.0 : value_of(line.values, tag.weight);
    if (weight <= 0.0) continue;
    sums[i].tag = full_name(tag, line.phase);
    sums[i].value += weight * value->second;
    sums[i].weight += weight;
  }
  const std::int64_t all = *std::ranges::min_element(group.reached);
  while (!group.waiting.empty() && group.waiting.begin()->first <= all) {
    StepScalars scalars{group.waiting.begin()->first, {}};
    for (const auto& [tag, value, weight] : group.waiting.begin()->second) {
      if (weight > 0.0) scalars.values.emplace_back(tag, value / weight);
    }
    group.given_on = scalars.step;
    if (!scalars.values.empty()) ready_.push_back(std::move(scalars));
    group.waiting.erase(group.waiting.begin());
  }
}

std::vector<StepScalars> TrainingScalars::take() { return std::exchange(ready_, {}); }

void TrainingScalars::go_back_to(std::int64_t step) {
  for (auto& [process, group] : groups_) {
    group.waiting.clear();
    for (std::int64_t& reached : group.reached) reached = std::min(reached, step);
    group.given_on = std::min(group.given_on, step);
  }
}

}  // namespace corridor::cluster
