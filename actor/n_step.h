// SPDX-License-Identifier: Apache-2.0
// Steps of an episode -> n-step transitions as rows (proto/settings/transition.h).
#pragma once

#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "proto/settings/settings.h"
#include "proto/settings/transition.h"

namespace corridor::actor {

// A row is complete n steps later, or when the episode ends for learning. One thread owns it.
class NStepBuilder {
 public:
  NStepBuilder(RowLayout layout, const DqnSettings& dqn);

  // One step: what was observed before it, what was done, and what came of it. After a terminal
  // step nothing is bootstrapped from; further steps may follow and stand on their own.
  struct Outcome {
    double reward = 0.0;  // unscaled
    double cost = 0.0;    // of a collision
    bool terminal = false;
  };
  void push(std::span<const float> observation, int action, const Outcome& outcome);

  // The episode is cut off without being over for learning (step limit, evaluation): bootstraps
  // from `last_observation`.
  void cut_off(std::span<const float> last_observation);

  // The rows completed since the last call, oldest first.
  std::vector<float> take_rows();

 private:
  struct Step {
    std::vector<float> observation;
    int action;
    double reward;
    double cost;
  };
  // Completes the oldest pending step with everything that is pending.
  void emit(std::optional<std::span<const float>> next_observation);

  RowLayout layout_;
  std::size_t n_;
  double gamma_;
  double risk_gamma_;
  double reward_scale_;
  std::deque<Step> pending_;
  std::vector<float> rows_;
};

}  // namespace corridor::actor
