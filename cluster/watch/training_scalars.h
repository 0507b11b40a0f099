// A training's metrics -> scalars by TensorBoard's tags over environment steps. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <string>
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

// What one process says is given on as it is, the actors' means when all of them have come to a
// step: of no tag does a step come twice, or after a later one, which would make TensorBoard forget
// values.
class TrainingScalars {
 public:
  TrainingScalars(const Schedule& schedule, int actors);

  void on_actor(int actor, const MetricsLine& line);
  void on_learner(const MetricsLine& line);
  void on_replay(const MetricsLine& line);

  // Those since the last call.
  std::vector<StepScalars> take();

  // All processes go on after this step: what was given on of later ones, comes again.
  void go_back_to(std::int64_t step);

  // What both phases' rounds before that one come to.
  std::int64_t steps_before(std::uint64_t round) const;

 private:
  struct Sum {
    double value = 0.0;
    double weight = 0.0;
  };
  void give_on(const MetricsLine& line, const char* process, std::int64_t& last);

  std::int64_t steps_per_round_;
  std::vector<std::int64_t> actors_reached_;                           // by actor
  std::map<std::int64_t, std::map<std::string, Sum>> waiting_;         // by step, tag
  std::int64_t actors_last_ = 0, learner_last_ = 0, replay_last_ = 0;  // steps given on
  std::vector<StepScalars> ready_;
};

}  // namespace corridor::cluster
