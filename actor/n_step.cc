// SPDX-License-Identifier: Apache-2.0
#include "actor/n_step.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "proto/base/failure.h"

namespace corridor::actor {

NStepBuilder::NStepBuilder(RowLayout layout, const DqnSettings& dqn)
    : layout_(layout),
      n_(static_cast<std::size_t>(dqn.n_step)),
      gamma_(dqn.gamma),
      risk_gamma_(dqn.risk_gamma),
      reward_scale_(dqn.reward_scale) {}

void NStepBuilder::push(std::span<const float> observation, int action, const Outcome& outcome) {
  CORRIDOR_CHECK(observation.size() == layout_.next_observation(), "{}", observation.size());
  if (pending_.size() == n_) emit(observation);
  pending_.push_back(
      {{observation.begin(), observation.end()}, action, outcome.reward, outcome.cost});
  if (outcome.terminal) {
    while (!pending_.empty()) emit(std::nullopt);
  }
}

void NStepBuilder::cut_off(std::span<const float> last_observation) {
  while (!pending_.empty()) emit(last_observation);
}

std::vector<float> NStepBuilder::take_rows() { return std::exchange(rows_, {}); }

void NStepBuilder::emit(std::optional<std::span<const float>> next_observation) {
  double n_step_return = 0.0, discount = 1.0;
  double risk_return = 0.0, risk_discount = 1.0;
  for (const Step& step : pending_) {
    n_step_return += discount * step.reward;
    risk_return += risk_discount * step.cost;
    discount *= gamma_;
    risk_discount *= risk_gamma_;
  }
  const std::size_t start = rows_.size();
  rows_.resize(start + layout_.stride(), 0.0f);
  float* row = rows_.data() + start;
  const Step& first = pending_.front();
  std::copy(first.observation.begin(), first.observation.end(), row);
  if (next_observation) {
    std::copy(next_observation->begin(), next_observation->end(), row + layout_.next_observation());
    row[layout_.discount()] = static_cast<float>(discount);
    row[layout_.risk_discount()] = static_cast<float>(risk_discount);
  }
  row[layout_.action()] = static_cast<float>(first.action);
  row[layout_.n_step_return()] = static_cast<float>(reward_scale_ * n_step_return);
  row[layout_.risk_return()] = static_cast<float>(risk_return);
  pending_.pop_front();
}

}  // namespace corridor::actor
