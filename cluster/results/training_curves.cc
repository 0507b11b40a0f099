// SPDX-License-Identifier: Apache-2.0
#include "cluster/results/training_curves.h"

#include <algorithm>
#include <map>
#include <set>

#include "proto/base/failure.h"

namespace corridor::cluster {

ProcessMetrics parse_metrics(std::string_view text, const std::string& name) {
  ProcessMetrics lines;
  int number = 1;
  for (std::size_t end; (end = text.find('\n')) != std::string_view::npos; ++number) {
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end + 1);
    if (auto parsed = parse_metrics_line(line)) {
      lines.push_back(std::move(*parsed));
    } else if (line.ends_with('}')) {  // only the process's death leaves a line without its end
      throw Failure("{}:{} is no line of metrics: the file is damaged; remove the line", name,
                    number);
    }
  }
  return lines;
}

Curve curve_of(const std::vector<ProcessMetrics>& processes, Phase phase, std::string_view name,
               std::string_view weight) {
  std::map<std::int64_t, CurvePoint> sums;
  for (const ProcessMetrics& lines : processes) {
    std::map<std::int64_t, const MetricsLine*> last;
    for (const MetricsLine& line : lines) {
      if (line.phase == phase_name(phase)) last[line.step] = &line;
    }
    for (const auto& [step, line] : last) {
      const auto value = line->values.find(name);
      if (value == line->values.end()) continue;
      const double share = weight.empty() ? 1.0 : value_of(line->values, weight);
      if (share <= 0.0) continue;
      CurvePoint& sum = sums.try_emplace(step, CurvePoint{step, 0.0, 0.0}).first->second;
      sum.value += share * value->second;
      sum.weight += share;
    }
  }
  Curve curve;
  for (const auto& [step, sum] : sums) curve.push_back({step, sum.value / sum.weight, sum.weight});
  return curve;
}

Curve moving_average(const Curve& curve, std::int64_t window_steps) {
  Curve result;
  auto first = curve.begin(), end = curve.begin();
  for (const CurvePoint& point : curve) {
    while (first->step < point.step - window_steps / 2) ++first;
    while (end != curve.end() && end->step <= point.step + window_steps / 2) ++end;
    CurvePoint mean{point.step, 0.0, 0.0};
    for (auto other = first; other != end; ++other) {
      mean.value += other->weight * other->value;
      mean.weight += other->weight;
    }
    mean.value /= mean.weight;
    result.push_back(mean);
  }
  return result;
}

Band band_of(const std::vector<Curve>& curves) {
  std::map<std::int64_t, std::vector<double>> values;
  for (const Curve& curve : curves) {
    for (const CurvePoint& point : curve) values[point.step].push_back(point.value);
  }
  Band band;
  for (const auto& [step, at_step] : values) {
    if (at_step.size() < curves.size()) continue;
    double sum = 0.0;
    for (const double value : at_step) sum += value;
    const auto [low, high] = std::minmax_element(at_step.begin(), at_step.end());
    band.push_back({step, sum / static_cast<double>(at_step.size()), *low, *high});
  }
  return band;
}

std::optional<Level> level_of(const std::vector<EvaluationRecord>& results,
                              std::string_view planner, Phase phase, int episode_steps) {
  std::set<std::uint64_t> seeds;
  double steps = 0.0, reward = 0.0, collisions = 0.0, whole = 0.0, reward_of_whole = 0.0;
  for (const EvaluationRecord& result : results) {
    if (result.planner != planner || !seeds.insert(result.seed).second) continue;
    for (const EpisodeRecord& episode : result.per_episode) {
      const double of_episode = phase == Phase::kMop ? episode.mop_reward : episode.bp_reward;
      steps += static_cast<double>(episode.steps);
      reward += of_episode;
      collisions += static_cast<double>(episode.collisions);
      if (episode.collisions == 0 && episode.steps < episode_steps) continue;
      whole += 1.0;
      reward_of_whole += of_episode;
    }
  }
  if (whole == 0.0) return std::nullopt;
  return Level{1000.0 * reward / steps, 1000.0 * collisions / steps, reward_of_whole / whole};
}

}  // namespace corridor::cluster
