// SPDX-License-Identifier: Apache-2.0
// The metrics of trainings -> curves over environment steps: what the paper's training figures
// show. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proto/run/evaluation_record.h"
#include "proto/run/metrics.h"
#include "proto/settings/named_networks.h"

namespace corridor::cluster {

// The lines of one metrics file, in its order.
using ProcessMetrics = std::vector<MetricsLine>;

// The lines of a whole metrics file. A line that a process died in is left out, as is one at the
// end that is not whole yet; throws Failure with `name` and the line's number for any other that is
// no metrics line.
ProcessMetrics parse_metrics(std::string_view text, const std::string& name);

struct CurvePoint {
  std::int64_t step = 0;  // of the phase, all actors together
  double value = 0.0;
  double weight = 1.0;  // what the value is a mean over, for further means

  bool operator==(const CurvePoint&) const = default;
};
using Curve = std::vector<CurvePoint>;  // ascending in step, each once

// A number of the phase's lines; `weight` names the number that says what it is a mean over, of
// equal weight when empty. Lines of several processes at one step become their weighted mean. Where
// one process wrote a step again (after a resume), what it wrote last counts.
Curve curve_of(const std::vector<ProcessMetrics>& processes, Phase phase, std::string_view name,
               std::string_view weight = {});

// At each point the weighted mean of those at most window_steps / 2 before and after it.
Curve moving_average(const Curve& curve, std::int64_t window_steps);

// Several training seeds' curves at the steps that all of them have.
struct BandPoint {
  std::int64_t step = 0;
  double mean = 0.0;
  double low = 0.0;
  double high = 0.0;

  bool operator==(const BandPoint&) const = default;
};
using Band = std::vector<BandPoint>;
Band band_of(const std::vector<Curve>& curves);

// What a planner pair reaches in evaluations, in the units of the training curves. The reward is
// that of the phase's planner, without shaping, as while training.
struct Level {
  double reward_per_1000 = 0.0;
  double collisions_per_1000 = 0.0;
  double reward_per_episode =
      0.0;  // of whole episodes: ended by a collision or after episode_steps
};
// Over all results of the pair, of each evaluation seed the first. Nothing without results or
// without whole episodes.
std::optional<Level> level_of(const std::vector<EvaluationRecord>& results,
                              std::string_view planner, Phase phase, int episode_steps);

}  // namespace corridor::cluster
