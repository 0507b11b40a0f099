// SPDX-License-Identifier: Apache-2.0
#include "cluster/results/results.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "proto/base/failure.h"
#include "proto/settings/planner_pairs.h"

namespace corridor::cluster {
namespace {

constexpr double kPer = 1000.0;  // steps

// A quantity that is a sum over episodes over the sum of what it is counted by.
struct Mean {
  Quantity quantity;
  double (*numerator)(const EpisodeRecord&);
  double (*denominator)(const EpisodeRecord&, double step_s);
};

template <auto kField>
double total(const EpisodeRecord& episode) {
  return static_cast<double>(episode.*kField);
}
double kilometres(const EpisodeRecord& episode) { return episode.distance_m / 1000.0; }

double thousands_of_steps(const EpisodeRecord& episode, double) {
  return static_cast<double>(episode.steps) / kPer;
}
double kilometres_driven(const EpisodeRecord& episode, double) { return kilometres(episode); }
double hours(const EpisodeRecord& episode, double step_s) {
  return static_cast<double>(episode.steps) * step_s / 3600.0;
}

constexpr Mean kMeans[] = {
    {Quantity::kBpReward, total<&EpisodeRecord::bp_reward>, thousands_of_steps},
    {Quantity::kLaneChanges, total<&EpisodeRecord::lane_changes>, thousands_of_steps},
    {Quantity::kSpeed, kilometres, hours},
    {Quantity::kHardBrakes, total<&EpisodeRecord::hard_brakes>, thousands_of_steps},
    {Quantity::kLaneChangesPerKm, total<&EpisodeRecord::lane_changes>, kilometres_driven},
    {Quantity::kBypassesPerKm, total<&EpisodeRecord::bypasses>, kilometres_driven},
};

// What is drawn by the bootstrap: episodes, or training seeds.
struct Units {
  std::vector<double> numerators;
  std::vector<double> denominators;
};

class ArmData {
 public:
  explicit ArmData(std::string planner)
      : planner_(std::move(planner)), learned_(planner_pair(planner_).learned()) {}

  bool empty() const { return results_.empty(); }
  void add(const SeedResult& added) {
    // Where nothing is learned all training seeds are one.
    const std::uint64_t training_seed = learned_ ? added.training_seed : 0;
    const EvaluationRecord*& slot = results_[training_seed][added.result.seed];
    CORRIDOR_CHECK(!learned_ || slot == nullptr, "{}, training seed {}, evaluation seed {}: twice",
                   planner_, training_seed, added.result.seed);
    if (slot == nullptr || slot->steps < added.result.steps) slot = &added.result;
  }

  Arm arm() const {
    Arm arm;
    arm.planner = planner_;
    arm.training_seeds = learned_ ? results_.size() : 0;
    std::set<std::uint64_t> evaluation_seeds;
    CollisionCounts by_kind{};
    std::vector<double> lane_steps;
    for (const auto& [training_seed, by_seed] : results_) {
      for (const auto& [evaluation_seed, result] : by_seed) {
        evaluation_seeds.insert(evaluation_seed);
        arm.steps += result->steps;
        arm.distance_km += result->distance_km;
        arm.collisions += result->collisions;
        for (std::size_t kind = 0; kind < kCollisionKinds; ++kind)
          by_kind[kind] += result->collisions_by_kind[kind];
        add_lane_steps(*result, lane_steps);
      }
    }
    arm.evaluation_seeds = evaluation_seeds.size();
    const double all = std::accumulate(lane_steps.begin(), lane_steps.end(), 0.0);
    for (const double steps : lane_steps) arm.lane_shares.push_back(all > 0.0 ? steps / all : 0.0);

    const double thousands = static_cast<double>(arm.steps) / kPer;
    arm.estimates = {{Quantity::kCollisions, rate(arm.collisions, thousands)},
                     {Quantity::kCollisionsPerKm, rate(arm.collisions, arm.distance_km)}};
    constexpr std::array kKinds = {Quantity::kRearEnded, Quantity::kRearEnding,
                                   Quantity::kSideByOther, Quantity::kSideByEgo,
                                   Quantity::kOffRoad};
    for (std::size_t kind = 0; kind < kCollisionKinds; ++kind)
      arm.estimates[kKinds[kind]] = rate(by_kind[kind], thousands);
    for (const Mean& mean : kMeans) {
      arm.estimates[mean.quantity] = {
          interquartile_mean(seed_values(mean)),
          percentile_interval(resampled(mean.quantity, kBootstrapSeed))};
    }
    return arm;
  }

  // The bootstrap's values of a quantity.
  std::vector<double> resampled(Quantity quantity, std::uint64_t seed) const {
    const auto mean = std::ranges::find(kMeans, quantity, &Mean::quantity);
    CORRIDOR_CHECK(mean != std::end(kMeans), "{}", static_cast<int>(quantity));
    if (results_.size() > 1) return bootstrap_interquartile_means(seed_values(*mean), seed);
    const Units units = episodes(results_.begin()->second, *mean);
    std::vector<double> values = bootstrap_ratios(units.numerators, units.denominators, seed);
    // Over nothing, where the ego stood still.
    for (double& value : values) value = std::isfinite(value) ? value : 0.0;
    return values;
  }

 private:
  static void add_lane_steps(const EvaluationRecord& result, std::vector<double>& lane_steps) {
    for (const EpisodeRecord& episode : result.per_episode) {
      lane_steps.resize(std::max(lane_steps.size(), episode.lane_steps.size()));
      for (std::size_t lane = 0; lane < episode.lane_steps.size(); ++lane)
        lane_steps[lane] += static_cast<double>(episode.lane_steps[lane]);
    }
  }

  // 0 where nothing was driven.
  static Estimate rate(std::int64_t count, double exposure) {
    if (exposure <= 0.0) return {};
    const Interval interval = poisson_interval(count);
    return {static_cast<double>(count) / exposure,
            {interval.low / exposure, interval.high / exposure}};
  }

  // All episodes of one training seed.
  static Units episodes(const std::map<std::uint64_t, const EvaluationRecord*>& by_seed,
                        const Mean& mean) {
    Units units;
    for (const auto& [evaluation_seed, result] : by_seed) {
      const double step_s = result->step_s;
      for (const EpisodeRecord& episode : result->per_episode) {
        units.numerators.push_back(mean.numerator(episode));
        units.denominators.push_back(mean.denominator(episode, step_s));
      }
    }
    return units;
  }

  std::vector<double> seed_values(const Mean& mean) const {
    const auto sum = [](const std::vector<double>& values) {
      return std::accumulate(values.begin(), values.end(), 0.0);
    };
    std::vector<double> values;
    for (const auto& [training_seed, by_seed] : results_) {
      const Units units = episodes(by_seed, mean);
      const double denominator = sum(units.denominators);
      values.push_back(denominator > 0.0 ? sum(units.numerators) / denominator : 0.0);
    }
    return values;
  }

  std::string planner_;
  bool learned_;
  // By training seed, then evaluation seed.
  std::map<std::uint64_t, std::map<std::uint64_t, const EvaluationRecord*>> results_;
};

std::optional<Estimate> ratio(Quantity quantity, const Arm& arm, const ArmData& data,
                              const Arm& baseline, const ArmData& baseline_data) {
  const double value = arm[quantity].value, other = baseline[quantity].value;
  if (other <= 0.0) return std::nullopt;
  if (quantity == Quantity::kCollisions) {
    return Estimate{value / other, poisson_ratio_interval(
                                       arm.collisions, static_cast<double>(arm.steps),
                                       baseline.collisions, static_cast<double>(baseline.steps))};
  }
  std::vector<double> ratios = data.resampled(quantity, kBootstrapSeed);
  const std::vector<double> others = baseline_data.resampled(quantity, kBootstrapSeed + 1);
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    ratios[i] = others[i] > 0.0 ? ratios[i] / others[i] : std::numeric_limits<double>::infinity();
  }
  return Estimate{value / other, percentile_interval(std::move(ratios))};
}

}  // namespace

std::vector<Arm> arms_of(const std::vector<SeedResult>& results) {
  std::vector<ArmData> data;
  std::vector<Arm> arms;
  for (const PlannerPair& pair : kPlannerPairs) {
    ArmData arm(pair.name);
    for (const SeedResult& result : results) {
      if (result.result.planner == pair.name) arm.add(result);
    }
    if (arm.empty()) continue;
    arms.push_back(arm.arm());
    data.push_back(std::move(arm));
  }

  const auto ratios_to = [&](const char* name, std::size_t index) -> std::optional<Ratios> {
    const auto baseline = std::ranges::find(arms, name, &Arm::planner);
    const auto at = static_cast<std::size_t>(baseline - arms.begin());
    if (at == arms.size() || at == index) return std::nullopt;
    Ratios ratios;
    for (std::size_t i = 0; i < kCompared.size(); ++i) {
      ratios[i] = ratio(kCompared[i], arms[index], data[index], *baseline, data[at]);
    }
    return ratios;
  };
  for (std::size_t i = 0; i < arms.size(); ++i) {
    arms[i].to_rules = ratios_to(kRules, i);
    arms[i].to_sumo = ratios_to(kSumo, i);
  }
  return arms;
}

}  // namespace corridor::cluster
