// SPDX-License-Identifier: Apache-2.0
#include "learner/td_update.h"

#include <cmath>

#include "proto/base/failure.h"
#include "proto/base/random.h"

namespace corridor::learner {
namespace {

// The members of TdState that have a value for each parameter.
constexpr std::vector<float> TdState::*kPerParameter[] = {
    &TdState::online, &TdState::target, &TdState::mean_gradient, &TdState::mean_squared_gradient};

// The state of the network whose parameters begin at `start`.
TdState part_of(const TdState& state, std::size_t start, std::size_t size) {
  TdState part;
  for (const auto member : kPerParameter) {
    const auto first = (state.*member).begin() + static_cast<std::ptrdiff_t>(start);
    (part.*member).assign(first, first + static_cast<std::ptrdiff_t>(size));
  }
  part.updates = state.updates;
  return part;
}

}  // namespace

std::vector<float> initial_parameters(const NetworkShape& shape, std::uint64_t seed, Phase phase,
                                      int networks) {
  std::vector<float> values(static_cast<std::size_t>(networks) * shape.parameters());
  for (std::size_t start = 0; start < values.size(); start += shape.parameters()) {
    for (const NetworkShape::Layer& layer : shape.layers()) {
      const double bound = 1.0 / std::sqrt(static_cast<double>(layer.inputs));
      const std::size_t end = start + layer.biases + static_cast<std::size_t>(layer.outputs);
      for (std::size_t i = start + layer.weights; i < end; ++i) {
        const double unit =
            random_unit(seed, Purpose::kInitialWeights, {static_cast<std::uint64_t>(phase), i});
        values[i] = static_cast<float>(bound * (2.0 * unit - 1.0));
      }
    }
  }
  return values;
}

TdState initial_td_state(const std::vector<float>& parameters) {
  const std::vector<float> zeros(parameters.size(), 0.0f);
  return {parameters, parameters, zeros, zeros, 0};
}

TdUpdate::TdUpdate(const NetworkShape& shape, const DqnSettings& dqn, Device device,
                   const TdState& state)
    : shape_(shape), dqn_(dqn), updates_(state.updates) {
  const std::size_t size = shape.parameters();
  for (const auto member : kPerParameter) {
    CORRIDOR_CHECK((state.*member).size() == static_cast<std::size_t>(dqn.networks()) * size,
                   "{} values for {} networks of {} parameters", (state.*member).size(),
                   dqn.networks(), size);
  }
  for (std::size_t start = 0; start < state.online.size(); start += size) {
    const TdState part = part_of(state, start, size);
    networks_.push_back(device == Device::kCpu ? cpu_networks(shape, dqn, part)
                                               : torch_networks(shape, dqn, device, part));
  }
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
  std::vector<BatchQValues> q;
  for (const auto& networks : networks_) {
    q.push_back(networks->forward(batch.rows, static_cast<int>(size)));
  }
  const auto next = dqn_.double_q ? &BatchQValues::online_next : &BatchQValues::target_next;
  const std::vector<std::size_t> next_actions =
      greedy_actions(q[0].*next, q.size() > 1 ? q[1].*next : std::span<const float>(),
                     dqn_.risk_weight, shape_.actions);

  Result result;
  result.priorities.assign(size, 0.0f);
  const ReturnColumns columns[] = {{layout.n_step_return(), layout.discount()},
                                   {layout.risk_return(), layout.risk_discount()}};
  for (std::size_t i = 0; i < networks_.size(); ++i) {
    const TdLoss loss = td_loss(batch.rows, layout, columns[i], batch.weights, q[i], next_actions,
                                shape_.actions, dqn_.huber_delta);
    const double gradient_norm = networks_[i]->step(loss.q_gradient, learning_rate);
    result.loss += loss.loss;
    (i == 0 ? result.q_value : result.risk) = loss.q_value;
    if (i == 0) result.gradient_norm = gradient_norm;
    for (std::size_t row = 0; row < size; ++row) result.priorities[row] += loss.priorities[row];
  }
  ++updates_;
  if (updates_ % static_cast<std::uint64_t>(dqn_.target_copy_updates) == 0) {
    for (const auto& networks : networks_) networks->copy_to_target();
  }
  return result;
}

std::vector<float> TdUpdate::parameters() const {
  std::vector<float> all;
  for (const auto& networks : networks_) {
    const std::vector<float> own = networks->parameters();
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

TdState TdUpdate::state() const {
  TdState all;
  for (const auto& networks : networks_) {
    const TdState own = networks->state();
    for (const auto member : kPerParameter) {
      (all.*member).insert((all.*member).end(), (own.*member).begin(), (own.*member).end());
    }
    all.updates = own.updates;
  }
  return all;
}

}  // namespace corridor::learner
