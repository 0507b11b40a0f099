// SPDX-License-Identifier: Apache-2.0
// A training's metrics -> scalars by TensorBoard's tags over environment steps. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "proto/run/metrics.h"
#include "proto/settings/schedule.h"

namespace corridor::cluster {

struct StepScalars {
  std::int64_t step = 0;                               // of both phases, all actors together
  std::vector<std::pair<std::string, double>> values;  // by tag: "train/mop/loss"

  bool operator==(const StepScalars&) const = default;
};

// Means over the processes of a name, given on when all of them have come to a step: of no tag does
// a step come twice, or after a later one, which would make TensorBoard forget values.
class TrainingScalars {
 public:
  TrainingScalars(const Schedule& schedule, int actors);

  // Of kLearnerName, kReplayName or the actor `index` of kActorName.
  void on(std::string_view process, std::size_t index, const MetricsLine& line);

  // Those since the last call.
  std::vector<StepScalars> take();

  // All processes go on after this step: what was given on of later ones, comes again.
  void go_back_to(std::int64_t step);

  // What both phases' rounds before that one come to.
  std::int64_t steps_before(std::uint64_t round) const;

 private:
  struct Sum {
    std::string tag;
    double value = 0.0;
    double weight = 0.0;
  };
  struct Group {
    std::vector<std::int64_t> reached;                 // by process
    std::map<std::int64_t, std::vector<Sum>> waiting;  // by step; as in the table of tags
    std::int64_t given_on = 0;                         // up to this step
  };

  std::int64_t steps_per_round_;
  std::map<std::string, Group, std::less<>> groups_;  // processes by name
  std::vector<StepScalars> ready_;
};

}  // namespace corridor::cluster
