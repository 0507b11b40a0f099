#include "learner/td_update.h"

#include <utility>

#include "learner/td_loss.h"
#include "proto/failure.h"

namespace corridor::learner {

TdState initial_td_state(std::vector<float> parameters) {
  const std::vector<float> zeros(parameters.size(), 0.0f);
  return {parameters, parameters, zeros, zeros, 0};
}

TdUpdate::TdUpdate(const NetworkShape& shape, const DqnSettings& dqn, const std::string& device,
                   const TdState& state)
    : shape_(shape), dqn_(dqn), updates_(state.updates) {
  CORRIDOR_CHECK(state.mean_gradient.size() == shape.parameters() &&
                     state.mean_squared_gradient.size() == shape.parameters(),
                 "{} moments for {} parameters", state.mean_gradient.size(), shape.parameters());
  networks_ =
      device == "cpu" ? cpu_networks(shape, dqn, state) : torch_networks(shape, dqn, device, state);
}

TdUpdate::Result TdUpdate::update(const Batch& batch, double learning_rate) {
  const RowLayout layout{shape_.observations};
  const std::size_t size = batch.weights.size();
  if (size == 0 || batch.rows.size() != size * layout.stride()) {
    throw Failure(
        "a batch of {} rows has {} values, not {} a row: do all processes run the same "
        "build?",
        size, batch.rows.size(), layout.stride());
  }
  const BatchQValues q = networks_->forward(batch.rows, static_cast<int>(size));
  TdLoss loss = td_loss(batch.rows, layout, batch.weights, q, shape_.actions,
                        {dqn_.double_q, dqn_.huber_delta});
  const double gradient_norm = networks_->step(loss.q_gradient, learning_rate);
  ++updates_;
  if (updates_ % static_cast<std::uint64_t>(dqn_.target_copy_updates) == 0) {
    networks_->copy_to_target();
  }
  return {loss.loss, loss.q_value, gradient_norm, std::move(loss.priorities)};
}

}  // namespace corridor::learner
