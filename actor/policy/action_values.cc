// SPDX-License-Identifier: Apache-2.0
#include "actor/policy/action_values.h"

#include <algorithm>
#include <cmath>

#include "proto/base/failure.h"

namespace corridor::policy {

ActionValues::ActionValues(const DqnSettings& dqn, PlannerShape shape,
                           std::span<const float> parameters)
    : risk_weight_(static_cast<float>(dqn.risk_weight)), observations_(shape.observations) {
  const NetworkShape network = dqn.network(shape);
  const std::size_t size = network.parameters();
  const auto networks = static_cast<std::size_t>(dqn.networks());
  CORRIDOR_CHECK(parameters.size() == networks * size, "{} parameters for {} networks of {}",
                 parameters.size(), networks, size);
  for (std::size_t i = 0; i < networks; ++i) {
    const auto own = parameters.subspan(i * size, size);
    networks_.emplace_back(network, std::vector<float>(own.begin(), own.end()));
  }
}

std::span<const float> ActionValues::values(std::span<const float> observation) {
  const auto q = networks_[0].q_values(observation);
  if (networks_.size() == 1) return q;
  const auto risk = networks_[1].q_values(observation);
  values_.resize(q.size());
  for (std::size_t i = 0; i < q.size(); ++i) {
    values_[i] = q[i] - risk_weight_ * std::max(0.0f, risk[i]);
  }
  return values_;
}

int ActionValues::greedy(std::span<const float> observation) { return argmax(values(observation)); }

ActionValues::Chosen ActionValues::look_up(std::span<const float> observation, int action) {
  const auto i = static_cast<std::size_t>(action);
  Chosen chosen{networks_[0].q_values(observation)[i]};
  if (networks_.size() > 1) chosen.risk = networks_[1].q_values(observation)[i];
  return chosen;
}

std::vector<float> ActionValues::td_errors(std::span<const float> rows) {
  const RowLayout layout{observations_};
  const std::size_t count = rows.size() / layout.stride();
  std::vector<float> errors(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto row = rows.subspan(i * layout.stride(), layout.stride());
    float target = row[layout.n_step_return()];
    float risk_target = row[layout.risk_return()];
    if (row[layout.discount()] > 0.0f) {
      const auto next = row.subspan(layout.next_observation(), layout.next_observation());
      const Chosen best = look_up(next, greedy(next));
      target += row[layout.discount()] * best.q;
      risk_target += row[layout.risk_discount()] * best.risk;
    }
    const Chosen now =
        look_up(row.first(layout.next_observation()), static_cast<int>(row[layout.action()]));
    errors[i] = std::abs(target - now.q);
    if (networks_.size() > 1) errors[i] += std::abs(risk_target - now.risk);
  }
  return errors;
}

int argmax(std::span<const float> values) {
  return static_cast<int>(std::max_element(values.begin(), values.end()) - values.begin());
}

}  // namespace corridor::policy
