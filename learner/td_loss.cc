// SPDX-License-Identifier: Apache-2.0
#include "learner/td_loss.h"

#include <algorithm>
#include <cmath>

#include "proto/base/failure.h"

namespace corridor::learner {
std::vector<std::size_t> greedy_actions(std::span<const float> q, std::span<const float> risk,
                                        double risk_weight, int actions) {
  const auto width = static_cast<std::size_t>(actions);
  CORRIDOR_CHECK(risk.empty() || risk.size() == q.size(), "{} and {}", q.size(), risk.size());
  std::vector<std::size_t> chosen(q.size() / width);
  const auto weight = static_cast<float>(risk_weight);
  const auto value = [&](std::size_t i) {
    return risk.empty() ? q[i] : q[i] - weight * std::max(0.0f, risk[i]);
  };
  for (std::size_t row = 0; row < chosen.size(); ++row) {
    for (std::size_t action = 1; action < width; ++action) {
      if (value(row * width + action) > value(row * width + chosen[row])) chosen[row] = action;
    }
  }
  return chosen;
}

TdLoss td_loss(std::span<const float> rows, const RowLayout& layout, const ReturnColumns& columns,
               std::span<const float> weights, const BatchQValues& q,
               std::span<const std::size_t> next_actions, int actions, double huber_delta) {
  const std::size_t batch = weights.size();
  const auto width = static_cast<std::size_t>(actions);
  CORRIDOR_CHECK(rows.size() == batch * layout.stride() && q.online.size() == batch * width &&
                     next_actions.size() == batch,
                 "{} values, {} weights, {} Q-values, {} next actions", rows.size(), batch,
                 q.online.size(), next_actions.size());
  TdLoss result;
  result.priorities.resize(batch);
  result.q_gradient.assign(batch * width, 0.0f);
  const double share = 1.0 / static_cast<double>(batch);

  for (std::size_t i = 0; i < batch; ++i) {
    const std::span<const float> row = rows.subspan(i * layout.stride(), layout.stride());
    const float action = row[layout.action()];
    if (!(action >= 0.0f && action < static_cast<float>(actions))) {
      throw Failure(
          "a replayed row has action {}, but the planner has {}: do all processes run the "
          "same build?",
          action, actions);
    }
    const std::size_t taken = i * width + static_cast<std::size_t>(action);

    const double target =
        static_cast<double>(row[columns.n_step_return]) +
        static_cast<double>(row[columns.discount]) * q.target_next[i * width + next_actions[i]];
    const double error = q.online[taken] - target;
    if (!std::isfinite(error)) {
      throw Failure("a TD error is {}: training has diverged; lower learning_rate or reward_scale",
                    error);
    }

    const double size = std::abs(error);
    const double huber =
        size <= huber_delta ? 0.5 * error * error : huber_delta * (size - 0.5 * huber_delta);
    result.loss += share * weights[i] * huber;
    result.q_value += share * q.online[taken];
    result.priorities[i] = static_cast<float>(size);
    result.q_gradient[taken] =
        static_cast<float>(share * weights[i] * std::clamp(error, -huber_delta, huber_delta));
  }
  return result;
}

}  // namespace corridor::learner
