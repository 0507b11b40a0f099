#include "learner/td_loss.h"

#include <algorithm>
#include <cmath>

#include "proto/failure.h"

namespace corridor::learner {
namespace {

std::size_t best_action(std::span<const float> q) {
  return static_cast<std::size_t>(std::max_element(q.begin(), q.end()) - q.begin());
}

}  // namespace

TdLoss td_loss(std::span<const float> rows, const RowLayout& layout, std::span<const float> weights,
               const BatchQValues& q, int actions, const TdLossSettings& settings) {
  const std::size_t batch = weights.size();
  const auto width = static_cast<std::size_t>(actions);
  CORRIDOR_CHECK(rows.size() == batch * layout.stride() && q.online.size() == batch * width,
                 "{} values, {} weights, {} Q-values", rows.size(), batch, q.online.size());
  TdLoss result;
  result.priorities.resize(batch);
  result.q_gradient.assign(batch * width, 0.0f);
  const double delta = settings.huber_delta;
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

    const std::span<const float> target_next = q.target_next.subspan(i * width, width);
    const std::size_t next =
        best_action(settings.double_q ? q.online_next.subspan(i * width, width) : target_next);
    const double target = static_cast<double>(row[layout.n_step_return()]) +
                          static_cast<double>(row[layout.discount()]) * target_next[next];
    const double error = q.online[taken] - target;
    if (!std::isfinite(error)) {
      throw Failure("a TD error is {}: training has diverged; lower learning_rate or reward_scale",
                    error);
    }

    const double size = std::abs(error);
    const double huber = size <= delta ? 0.5 * error * error : delta * (size - 0.5 * delta);
    result.loss += share * weights[i] * huber;
    result.q_value += share * q.online[taken];
    result.priorities[i] = static_cast<float>(size);
    result.q_gradient[taken] =
        static_cast<float>(share * weights[i] * std::clamp(error, -delta, delta));
  }
  return result;
}

}  // namespace corridor::learner
