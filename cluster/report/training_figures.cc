// SPDX-License-Identifier: Apache-2.0
#include "cluster/report/training_figures.h"

#include <algorithm>

#include "proto/base/format.h"
#include "proto/base/text.h"
#include "proto/run/metrics.h"

namespace corridor::cluster {
namespace {

// The moving averages of both phases are over this share of their steps together.
constexpr int kWindowsPerTraining = 25;

struct Quantity {
  const char* title;               // of the panel, behind the phase
  const char* unit;                // of the y axis
  const char* name;                // of the number in the metrics
  const char* weight;              // likewise; may be empty
  double Level::*level = nullptr;  // what the rules come to; of some quantities
};
constexpr Quantity kReward = {"reward", "reward per 1000 steps", metric::kRewardPer1000, "",
                              &Level::reward_per_1000};
constexpr Quantity kCollisions = {"collisions", "collisions per 1000 steps",
                                  metric::kCollisionsPer1000, "", &Level::collisions_per_1000};
constexpr Quantity kEpisode = {"reward of an episode", "reward per episode",
                               metric::kEpisodicReturn, metric::kEpisodes,
                               &Level::reward_per_episode};
constexpr Quantity kLoss = {"loss", "Huber loss of TD errors", metric::kTdLoss, ""};
constexpr Quantity kQ = {"Q-value", "scaled return", metric::kQValues, ""};
constexpr Quantity kRisk = {"risk", "discounted collisions", metric::kRiskValues, ""};
constexpr Quantity kGreedyReward = {"reward, greedy", "reward per 1000 steps",
                                    metric::kGreedyRewardPer1000, ""};
constexpr Quantity kGreedyCollisions = {"collisions, greedy", "collisions per 1000 steps",
                                        metric::kGreedyCollisionsPer1000, ""};
constexpr Quantity kScore = {"score", "reward - cost of collisions", metric::kGreedyScore, ""};

using Processes = std::vector<ProcessMetrics> RunRecord::*;

std::int64_t window_steps(const RunGroup& group) {
  const RunConfig& config = group.runs.front().config;
  std::int64_t steps = 0;
  for (const DqnSettings& dqn : config.dqn) steps += dqn.steps;
  return steps / kWindowsPerTraining;
}

// `averaged`: the trend is the moving average of many values, and these are drawn too.
PlottedCurve plotted(const RunGroup& group, Processes processes, Phase phase,
                     const Quantity& quantity, bool averaged) {
  std::vector<Curve> curves;
  for (const RunRecord& run : group.runs)
    curves.push_back(curve_of(run.*processes, phase, quantity.name, quantity.weight));
  const Band raw = band_of(curves);
  if (!averaged) return {{}, raw, {}};
  for (Curve& curve : curves) curve = moving_average(curve, window_steps(group));
  return {raw, band_of(curves), {}};
}

std::optional<Level> rules_level(const RunGroup& group, Phase phase) {
  std::vector<EvaluationRecord> results;
  for (const RunRecord& run : group.runs) {
    for (const std::string& world : run.worlds_of_training) {
      const auto& in_world = run.evaluations.at(world);
      results.insert(results.end(), in_world.begin(), in_world.end());
    }
  }
  return level_of(results, phase == Phase::kMop ? "random+rules" : "rules", phase,
                  group.runs.front().config.simulation.episode_steps);
}

// Panels without any curve are left out.
std::vector<Panel> panels_of(const std::vector<RunGroup>& groups, Processes processes, Phase phase,
                             const std::vector<Quantity>& quantities, bool averaged) {
  std::vector<Panel> panels;
  for (const Quantity& quantity : quantities) {
    Panel panel{fmt::format("{} {}", phase_name(phase), quantity.title), quantity.unit, {}};
    for (const RunGroup& group : groups) {
      panel.curves.push_back(plotted(group, processes, phase, quantity, averaged));
      if (quantity.level == nullptr) continue;
      if (const auto level = rules_level(group, phase)) {
        panel.curves.back().level = (*level).*quantity.level;
      }
    }
    if (std::ranges::any_of(panel.curves, [](const auto& curve) { return !curve.trend.empty(); })) {
      panels.push_back(std::move(panel));
    }
  }
  return panels;
}

std::string seeds_text(const std::vector<RunGroup>& groups) {
  std::string text;
  for (const RunGroup& group : groups) {
    const std::size_t seeds = group.runs.size();
    if (seeds == 1) continue;
    text +=
        fmt::format(" {}: mean of {} training seeds, with a band from the lowest to the highest.",
                    group.label, seeds);
  }
  return text;
}

std::string window_text(const std::vector<RunGroup>& groups) {
  std::vector<std::string> windows;
  for (const RunGroup& group : groups) {
    windows.push_back(grouped(window_steps(group)) + " steps");
    if (groups.size() > 1) windows.back() += " (" + group.label + ")";
  }
  return fmt::format("Thick: moving average over {}.", listed(windows));
}

void add_figures(std::vector<Figure>& figures, const std::vector<RunGroup>& groups, Phase phase) {
  const std::string prefix = named_network(phase).name + std::string("_");
  const std::string planner = phase_name(phase);
  std::vector<std::string> labels;
  for (const RunGroup& group : groups) labels.push_back(group.label);
  const auto add = [&](const char* name, const std::string& caption, Processes processes,
                       const std::vector<Quantity>& quantities, bool averaged) {
    std::vector<Panel> panels = panels_of(groups, processes, phase, quantities, averaged);
    if (panels.empty()) return;
    figures.push_back({prefix + name, caption + seeds_text(groups), labels,
                       averaged ? "moving average" : "selection", "rules", !averaged,
                       std::move(panels)});
  };

  add("training",
      fmt::format("Training of the {}: its reward and the collisions while exploring. {} Dashed: "
                  "the rules on held-out traffic{}.",
                  planner, window_text(groups),
                  phase == Phase::kMop ? ", under the same random BP" : ""),
      &RunRecord::actors, {kReward, kCollisions, kEpisode}, true);
  add("learning",
      fmt::format("What the learner of the {} says of its batches. {}", planner,
                  window_text(groups)),
      &RunRecord::learner, {kLoss, kQ, kRisk}, true);
  add("selection",
      fmt::format("Greedy evaluations of the {} during training, on episodes of their own: the "
                  "networks of the best score are kept.",
                  planner),
      &RunRecord::learner, {kGreedyReward, kGreedyCollisions, kScore}, false);
}

}  // namespace

std::vector<Figure> training_figures(const std::vector<RunGroup>& groups) {
  std::vector<Figure> figures;
  for (const NamedNetwork& network : kNetworks) add_figures(figures, groups, network.id);
  return figures;
}

}  // namespace corridor::cluster
