// SPDX-License-Identifier: Apache-2.0
#include "learner/td_update.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "learner/td_loss.h"
#include "proto/base/failure.h"
#include "proto/base/random.h"

namespace corridor::learner {
namespace {

constexpr int kObservations = 3;
constexpr int kHidden = 4;
constexpr int kActions = 2;
const NetworkShape kShape{kObservations, {kHidden}, kActions, false};
const RowLayout kLayout{kObservations};

double unit(std::uint64_t index) { return random_unit(99, Purpose::kBootstrap, {index}); }

Batch random_batch(std::uint64_t number, int rows) {
  Batch batch;
  std::uint64_t draw = number << 32;
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < 2 * kObservations; ++j) {
      batch.rows.push_back(static_cast<float>(2.0 * unit(draw++) - 1.0));
    }
    batch.rows.push_back(unit(draw++) < 0.5 ? 0.0f : 1.0f);
    batch.rows.push_back(static_cast<float>(4.0 * unit(draw++) - 2.0));
    const bool ends = unit(draw++) < 0.2;
    batch.rows.push_back(ends ? 0.0f : 0.9f);
    batch.rows.push_back(static_cast<float>(unit(draw++)));
    batch.rows.push_back(ends ? 0.0f : 0.7f);
    batch.keys.push_back(static_cast<std::uint64_t>(i));
    batch.weights.push_back(static_cast<float>(0.1 + 0.9 * unit(draw++)));
  }
  batch.observations = kObservations;
  return batch;
}

// The same training step of one network by hand, in doubles, for one hidden layer.
class HandTrainer {
 public:
  HandTrainer(const DqnSettings& dqn, const std::vector<float>& parameters)
      : dqn_(dqn),
        online_(parameters.begin(), parameters.end()),
        target_(online_),
        mean_(online_.size()),
        mean_squared_(online_.size()) {}

  // Q-values of a row's next observation, by the network that chooses the next action.
  std::vector<double> next_q(const float* row) const {
    std::vector<double> unused;
    return forward(dqn_.double_q ? online_ : target_, row + kObservations, unused);
  }

  // Returns the loss.
  double update(const Batch& batch, double learning_rate, const ReturnColumns& columns,
                const std::vector<int>& next_actions) {
    std::vector<double> gradient(online_.size(), 0.0);
    const double rows = static_cast<double>(batch.weights.size());
    double loss = 0.0;
    for (std::size_t i = 0; i < batch.weights.size(); ++i) {
      const float* row = batch.rows.data() + i * kLayout.stride();
      const auto action = static_cast<int>(row[kLayout.action()]);
      std::vector<double> hidden;
      const std::vector<double> q = forward(online_, row, hidden);
      std::vector<double> unused;
      const std::vector<double> next = forward(target_, row + kObservations, unused);
      const double target = row[columns.n_step_return] +
                            static_cast<double>(row[columns.discount]) * next[next_actions[i]];
      const double error = q[action] - target;
      const double delta = dqn_.huber_delta;
      loss +=
          batch.weights[i] / rows *
          (std::abs(error) <= delta ? error * error / 2 : delta * (std::abs(error) - delta / 2));
      backward(row, action, hidden, batch.weights[i] / rows * std::clamp(error, -delta, delta),
               gradient);
    }
    double norm = 0.0;
    for (const double g : gradient) norm += g * g;
    const double scale = std::min(1.0, dqn_.gradient_norm_max / std::sqrt(norm));
    ++step_;
    for (std::size_t i = 0; i < online_.size(); ++i) {
      const double g = scale * gradient[i];
      mean_[i] = 0.9 * mean_[i] + 0.1 * g;
      mean_squared_[i] = 0.999 * mean_squared_[i] + 0.001 * g * g;
      const double m = mean_[i] / (1.0 - std::pow(0.9, step_));
      const double v = mean_squared_[i] / (1.0 - std::pow(0.999, step_));
      online_[i] -= learning_rate * m / (std::sqrt(v) + dqn_.adam_epsilon);
    }
    if (step_ % dqn_.target_copy_updates == 0) target_ = online_;
    return loss;
  }

  const std::vector<double>& online() const { return online_; }
  const std::vector<double>& target() const { return target_; }
  const std::vector<double>& mean() const { return mean_; }
  const std::vector<double>& mean_squared() const { return mean_squared_; }

 private:
  static constexpr std::size_t kBiases1 = kHidden * kObservations;
  static constexpr std::size_t kWeights2 = kBiases1 + kHidden;
  static constexpr std::size_t kBiases2 = kWeights2 + kActions * kHidden;

  static std::vector<double> forward(const std::vector<double>& p, const float* x,
                                     std::vector<double>& hidden) {
    hidden.assign(kHidden, 0.0);
    for (int h = 0; h < kHidden; ++h) {
      double sum = p[kBiases1 + h];
      for (int i = 0; i < kObservations; ++i) sum += p[h * kObservations + i] * x[i];
      hidden[h] = std::max(0.0, sum);
    }
    std::vector<double> q(kActions);
    for (int a = 0; a < kActions; ++a) {
      q[a] = p[kBiases2 + a];
      for (int h = 0; h < kHidden; ++h) q[a] += p[kWeights2 + a * kHidden + h] * hidden[h];
    }
    return q;
  }

  void backward(const float* x, int action, const std::vector<double>& hidden, double q_gradient,
                std::vector<double>& gradient) const {
    gradient[kBiases2 + action] += q_gradient;
    for (int h = 0; h < kHidden; ++h) {
      const std::size_t weight = kWeights2 + action * kHidden + h;
      gradient[weight] += q_gradient * hidden[h];
      if (hidden[h] <= 0.0) continue;
      const double hidden_gradient = q_gradient * online_[weight];
      gradient[kBiases1 + h] += hidden_gradient;
      for (int i = 0; i < kObservations; ++i) {
        gradient[h * kObservations + i] += hidden_gradient * x[i];
      }
    }
  }

  DqnSettings dqn_;
  std::vector<double> online_, target_, mean_, mean_squared_;
  int step_ = 0;
};

void expect_near(const std::vector<float>& actual, const std::vector<double>& expected,
                 double tolerance, const char* what) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < actual.size(); ++i) {
    EXPECT_NEAR(actual[i], expected[i], tolerance) << what << ' ' << i;
  }
}

TdState start(const NetworkShape& shape, const DqnSettings& dqn) {
  return initial_td_state(initial_parameters(shape, 5, Phase::kMop, dqn.networks()));
}

DqnSettings with_risk_weight(double weight) {
  DqnSettings dqn;
  dqn.risk_weight = weight;
  return dqn;
}

std::vector<double> joined(std::vector<double> first, const std::vector<double>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

// Of Q - risk_weight * max(0, risk).
std::vector<int> next_actions(const Batch& batch, const HandTrainer& reward,
                              const HandTrainer& risk, double risk_weight) {
  std::vector<int> actions;
  for (std::size_t i = 0; i < batch.weights.size(); ++i) {
    const float* row = batch.rows.data() + i * kLayout.stride();
    const std::vector<double> q = reward.next_q(row), r = risk.next_q(row);
    actions.push_back(q[1] - risk_weight * std::max(0.0, r[1]) >
                      q[0] - risk_weight * std::max(0.0, r[0]));
  }
  return actions;
}

TEST(TdUpdate, AgreesWithAHandComputation) {
  for (const double risk_weight : {0.0, 1.5}) {
    for (const bool double_q : {true, false}) {
      for (const double norm_max : {0.05, 100.0}) {
        DqnSettings dqn = with_risk_weight(risk_weight);
        dqn.double_q = double_q;
        dqn.huber_delta = 0.7;
        dqn.gradient_norm_max = norm_max;
        dqn.target_copy_updates = 3;
        TdUpdate update(kShape, dqn, Device::kCpu, start(kShape, dqn));
        const auto initial = initial_parameters(kShape, 5, Phase::kMop, 2);
        const auto half = initial.begin() + static_cast<std::ptrdiff_t>(kShape.parameters());
        HandTrainer reward(dqn, {initial.begin(), half});
        HandTrainer risk(dqn, {half, initial.end()});
        const bool both = risk_weight > 0.0;
        for (std::uint64_t i = 0; i < 5; ++i) {
          const Batch batch = random_batch(i, 16);
          const TdUpdate::Result result = update.update(batch, 1e-2);
          const auto actions = next_actions(batch, reward, risk, risk_weight);
          double loss =
              reward.update(batch, 1e-2, {kLayout.n_step_return(), kLayout.discount()}, actions);
          const double risk_loss =
              risk.update(batch, 1e-2, {kLayout.risk_return(), kLayout.risk_discount()}, actions);
          if (both) loss += risk_loss;
          EXPECT_NEAR(result.loss, loss, 1e-5);
          EXPECT_GT(result.gradient_norm, 0.05);  // so that the small limit clips
          const auto of = [&](auto member) {
            return both ? joined((reward.*member)(), (risk.*member)()) : (reward.*member)();
          };
          const TdState state = update.state();
          expect_near(state.online, of(&HandTrainer::online), 1e-5, "online");
          expect_near(state.target, of(&HandTrainer::target), 1e-5, "target");
          expect_near(state.mean_gradient, of(&HandTrainer::mean), 1e-6, "mean gradient");
          expect_near(state.mean_squared_gradient, of(&HandTrainer::mean_squared), 1e-7,
                      "mean square");
        }
      }
    }
  }
}

TEST(TdUpdate, AddsUpThePrioritiesOfBothNetworks) {
  // Of last steps only, so that no next action matters; each network by itself sees its return in
  // the column of the first.
  Batch batch = random_batch(0, 8);
  Batch of_risk = batch;
  for (std::size_t i = 0; i < 8; ++i) {
    float* row = batch.rows.data() + i * kLayout.stride();
    row[kLayout.discount()] = row[kLayout.risk_discount()] = 0.0f;
    float* risk_row = of_risk.rows.data() + i * kLayout.stride();
    risk_row[kLayout.discount()] = 0.0f;
    risk_row[kLayout.n_step_return()] = row[kLayout.risk_return()];
  }
  const DqnSettings one = with_risk_weight(0.0), both = with_risk_weight(1.5);
  const std::vector<float> initial = initial_parameters(kShape, 5, Phase::kMop, 2);
  const auto half = initial.begin() + static_cast<std::ptrdiff_t>(kShape.parameters());
  const auto priorities = [](const DqnSettings& dqn, std::vector<float> parameters,
                             const Batch& of) {
    TdUpdate update(kShape, dqn, Device::kCpu, initial_td_state(std::move(parameters)));
    return update.update(of, 1e-3).priorities;
  };
  const auto reward = priorities(one, {initial.begin(), half}, batch);
  const auto risk = priorities(one, {half, initial.end()}, of_risk);
  const auto sum = priorities(both, initial, batch);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_GT(risk[i], 0.0f);
    EXPECT_FLOAT_EQ(sum[i], reward[i] + risk[i]) << i;
  }
}

TEST(TdUpdate, CopiesTheTargetEverySoManyUpdates) {
  DqnSettings dqn;
  dqn.target_copy_updates = 2;
  TdUpdate update(kShape, dqn, Device::kCpu, start(kShape, dqn));
  update.update(random_batch(0, 8), 1e-2);
  EXPECT_EQ(update.state().target, start(kShape, dqn).online);
  update.update(random_batch(1, 8), 1e-2);
  EXPECT_EQ(update.state().target, update.parameters());
  update.update(random_batch(2, 8), 1e-2);
  EXPECT_NE(update.state().target, update.parameters());
}

TEST(TdUpdate, ContinuesAnotherObjectsStateBitForBit) {
  for (const bool dueling : {false, true}) {
    const NetworkShape shape{kObservations, {16, 16}, kActions, dueling};
    DqnSettings dqn;
    dqn.target_copy_updates = 7;
    TdUpdate whole(shape, dqn, Device::kCpu, start(shape, dqn));
    TdUpdate first(shape, dqn, Device::kCpu, start(shape, dqn));
    for (std::uint64_t i = 0; i < 20; ++i) whole.update(random_batch(i, 32), 1e-3);
    for (std::uint64_t i = 0; i < 10; ++i) first.update(random_batch(i, 32), 1e-3);
    TdUpdate second(shape, dqn, Device::kCpu, first.state());
    EXPECT_EQ(second.state(), first.state());
    for (std::uint64_t i = 10; i < 20; ++i) second.update(random_batch(i, 32), 1e-3);
    EXPECT_EQ(second.state(), whole.state());
  }
}

TEST(TdUpdate, ChangesNothingByBeingMade) {
  TdState state = start(kShape, DqnSettings{});
  state.mean_gradient.assign(state.online.size(), 0.5f);
  state.mean_squared_gradient.assign(state.online.size(), 0.25f);
  state.updates = 12;
  EXPECT_EQ(TdUpdate(kShape, {}, Device::kCpu, state).state(), state);
}

TEST(TdUpdate, LearnsTheValuesOfAChain) {
  // Five states in a row; left and right; 1 for stepping right out of the last, which ends it.
  constexpr int kStates = 5;
  constexpr double kGamma = 0.9;
  std::array<std::array<double, 2>, kStates> exact{};
  const auto best = [&](int s) { return std::max(exact[s][0], exact[s][1]); };
  for (int sweep = 0; sweep < 200; ++sweep) {
    for (int s = 0; s < kStates; ++s) {
      exact[s] = {kGamma * best(std::max(s - 1, 0)), s + 1 < kStates ? kGamma * best(s + 1) : 1.0};
    }
  }
  Batch batch;
  const auto add_one_hot = [](std::vector<float>& out, int state) {
    for (int s = 0; s < kStates; ++s) out.push_back(s == state ? 1.0f : 0.0f);
  };
  for (int s = 0; s < kStates; ++s) {
    for (int action = 0; action < 2; ++action) {
      const bool ends = action == 1 && s + 1 == kStates;
      const int next = action == 0 ? std::max(s - 1, 0) : s + 1;
      add_one_hot(batch.rows, s);
      add_one_hot(batch.rows, ends ? -1 : next);
      batch.rows.insert(batch.rows.end(), {static_cast<float>(action), ends ? 1.0f : 0.0f,
                                           ends ? 0.0f : static_cast<float>(kGamma), 0.0f, 0.0f});
      batch.weights.push_back(1.0f);
    }
  }
  for (const bool dueling : {false, true}) {
    const NetworkShape shape{kStates, {32}, 2, dueling};
    DqnSettings dqn = with_risk_weight(0.0);
    dqn.target_copy_updates = 50;
    TdUpdate update(shape, dqn, Device::kCpu, start(shape, dqn));
    for (int i = 0; i < 3000; ++i) update.update(batch, 3e-3);
    const auto trained = cpu_networks(shape, dqn, initial_td_state(update.parameters()));
    const auto q = trained->forward(batch.rows, static_cast<int>(batch.weights.size())).online;
    for (int s = 0; s < kStates; ++s) {
      // Each state has two rows, of two actions each.
      EXPECT_NEAR(q[4 * s], exact[s][0], 0.02) << "state " << s << ", left";
      EXPECT_NEAR(q[4 * s + 1], exact[s][1], 0.02) << "state " << s << ", right";
    }
  }
}

TEST(TdUpdate, RefusesRowsOfAnotherLength) {
  TdUpdate update(kShape, {}, Device::kCpu, start(kShape, {}));
  Batch batch = random_batch(0, 4);
  batch.rows.pop_back();
  EXPECT_THROW(update.update(batch, 1e-3), Failure);
  EXPECT_THROW(update.update(Batch{}, 1e-3), Failure);
}

TEST(InitialParameters, AreUniformWithinOneOverTheRootOfTheFanIn) {
  const NetworkShape shape{100, {400}, 3, false};
  const std::vector<float> parameters = initial_parameters(shape, 7, Phase::kMop);
  ASSERT_EQ(parameters.size(), shape.parameters());
  const std::vector<float> first(parameters.begin(), parameters.begin() + 100 * 400);
  double sum = 0.0, squares = 0.0;
  float largest = 0.0f;
  for (const float value : first) {
    sum += value;
    squares += static_cast<double>(value) * value;
    largest = std::max(largest, std::abs(value));
  }
  EXPECT_LE(largest, 0.1f);
  EXPECT_GT(largest, 0.0999f);
  EXPECT_NEAR(sum / 40'000, 0.0, 4 * 0.1 / std::sqrt(3 * 40'000));
  EXPECT_NEAR(squares / 40'000, 0.01 / 3.0, 4 * 0.01 / std::sqrt(40'000.0) / 3.0);
}

TEST(InitialParameters, DependOnSeedAndPhaseOnly) {
  const NetworkShape shape{4, {8}, 3, false};
  EXPECT_EQ(initial_parameters(shape, 7, Phase::kMop), initial_parameters(shape, 7, Phase::kMop));
  EXPECT_NE(initial_parameters(shape, 7, Phase::kMop), initial_parameters(shape, 8, Phase::kMop));
  EXPECT_NE(initial_parameters(shape, 7, Phase::kMop), initial_parameters(shape, 7, Phase::kBp));
}

}  // namespace
}  // namespace corridor::learner
