// SPDX-License-Identifier: Apache-2.0
// Results of evaluations, over training and evaluation seeds -> one row of estimates for each
// planner pair ("arm"). Pure.
//
// Estimates, each with a 95 % interval:
// - Collisions, all and of each kind: the count of all training and evaluation seeds together over
//   their steps (or km); the interval is the exact one of a Poisson mean. It takes collisions for
//   independent, so what differs between training seeds is not in it.
// - Everything else, of an arm with a learned planner and at least two training seeds: a training
//   seed's value is its sum over its sum of steps (or km, or hours), all its evaluation seeds
//   together; the estimate is the interquartile mean of these values, the interval the percentile
//   bootstrap's over training seeds (rliable, Agarwal et al. 2021).
// - Everything else, of the other arms (nothing is learned, or there is one training seed): the sum
//   over all episodes over their steps; the interval is the percentile bootstrap's over episodes.
//   It says nothing about another training seed.
// - Ratios to a baseline: estimate over estimate. Collisions: the exact interval of the ratio of
//   two Poisson means. The rest: the percentile interval of the ratio of independent bootstraps of
//   both, each over its own units.
// An arm in which nothing is learned does the same whatever the training seed: of each evaluation
// seed one result counts, the longest, of equally long ones the first.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cluster/results/statistics.h"
#include "proto/run/evaluation_record.h"

namespace corridor::cluster {

struct Estimate {
  double value = 0.0;
  Interval interval;
};

// Sums per 1000 steps but for speed (km/h) and what is named per km.
enum class Quantity {
  kBpReward,
  kCollisions,
  kRearEnded,
  kRearEnding,
  kSideByOther,
  kSideByEgo,
  kOffRoad,
  kLaneChanges,
  kSpeed,
  kHardBrakes,
  kCollisionsPerKm,
  kLaneChangesPerKm,
  kBypassesPerKm,
};

// Those that are compared with baselines.
inline constexpr std::array kCompared = {Quantity::kBpReward, Quantity::kCollisions,
                                         Quantity::kLaneChanges, Quantity::kSpeed,
                                         Quantity::kHardBrakes};
// In that order; nothing where the baseline's value is not positive.
using Ratios = std::array<std::optional<Estimate>, kCompared.size()>;

// The baselines.
inline constexpr const char* kRules = "rules";
inline constexpr const char* kSumo = "sumo";

struct Arm {
  std::string planner;
  std::size_t training_seeds = 0;  // 0: nothing is learned
  std::size_t evaluation_seeds = 0;
  std::int64_t steps = 0;
  double distance_km = 0.0;
  std::int64_t collisions = 0;
  std::map<Quantity, Estimate> estimates;  // of each
  std::vector<double> lane_shares;         // of all steps, by lane, from the right
  // Nothing when the baseline is not among the results, or is this arm.
  std::optional<Ratios> to_rules;
  std::optional<Ratios> to_sumo;

  const Estimate& operator[](Quantity quantity) const { return estimates.at(quantity); }
};

// One evaluation of the networks of one training seed, in one scenario.
struct SeedResult {
  std::uint64_t training_seed = 0;
  EvaluationRecord result;
};

// One scenario's arms, in the order of kPlannerPairs. Of a learned arm there is one result for each
// training and evaluation seed.
std::vector<Arm> arms_of(const std::vector<SeedResult>& results);

inline constexpr std::uint64_t kBootstrapSeed = 1;  // a baseline's is the next

}  // namespace corridor::cluster
