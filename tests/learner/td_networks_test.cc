// SPDX-License-Identifier: Apache-2.0
#include "learner/td_networks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "learner/td_update.h"
#include "proto/base/failure.h"
#include "proto/base/random.h"

namespace corridor::learner {
namespace {

using testing::FloatNear;
using testing::HasSubstr;
using testing::Pointwise;

double uniform(std::uint64_t index) { return random_unit(7, Purpose::kBootstrap, {index}); }

std::vector<float> numbers(std::size_t size, std::uint64_t number) {
  std::vector<float> values;
  for (std::size_t i = 0; i < size; ++i) {
    values.push_back(static_cast<float>(2.0 * uniform((number << 32) + i) - 1.0));
  }
  return values;
}

void expect_near(std::span<const float> actual, std::span<const float> expected, const char* what) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < actual.size(); ++i) {
    ASSERT_NEAR(actual[i], expected[i], 1e-5 * std::max(1.0F, std::abs(expected[i])))
        << what << ' ' << i;
  }
}

// The definition in proto/settings/transition.h, in plain doubles.
std::vector<float> reference_forward(const NetworkShape& shape, const std::vector<float>& p,
                                     std::vector<double> input) {
  const auto apply = [&](const NetworkShape::Layer& layer, const std::vector<double>& x) {
    std::vector<double> y;
    for (int o = 0; o < layer.outputs; ++o) {
      double sum = p[layer.biases + o];
      for (int i = 0; i < layer.inputs; ++i) sum += p[layer.weights + o * layer.inputs + i] * x[i];
      y.push_back(sum);
    }
    return y;
  };
  const std::vector<NetworkShape::Layer> layers = shape.layers();
  for (std::size_t i = 0; i < shape.hidden.size(); ++i) {
    input = apply(layers[i], input);
    for (double& value : input) value = std::max(value, 0.0);
  }
  std::vector<double> q = apply(layers.back(), input);
  if (shape.dueling) {
    const double value = apply(layers[layers.size() - 2], input)[0];
    const double mean = std::accumulate(q.begin(), q.end(), 0.0) / static_cast<double>(q.size());
    for (double& action_value : q) action_value += value - mean;
  }
  return {q.begin(), q.end()};
}

TEST(TdNetworks, ComputeTheNetworkThatItsShapeDefines) {
  for (const bool dueling : {false, true}) {
    for (const std::vector<int>& hidden : {std::vector<int>{}, {7}, {8, 5}}) {
      const NetworkShape shape{6, hidden, 4, dueling};
      const RowLayout layout{shape.observations};
      const std::vector<float> parameters = initial_parameters(shape, 3, Phase::kBp);
      constexpr int kBatch = 3;
      const std::vector<float> rows = numbers(kBatch * layout.stride(), 1);
      std::vector<float> expected;
      for (int row = 0; row < kBatch; ++row) {
        const auto first = rows.begin() + static_cast<std::ptrdiff_t>(row * layout.stride());
        const std::vector<float> q =
            reference_forward(shape, parameters, {first, first + shape.observations});
        expected.insert(expected.end(), q.begin(), q.end());
      }
      const TdState state = initial_td_state(parameters);
      const auto by_hand = cpu_networks(shape, {}, state);
      const auto by_torch = torch_networks(shape, {}, Device::kCpu, state);
      for (TdNetworks* networks : {by_hand.get(), by_torch.get()}) {
        EXPECT_THAT(networks->forward(rows, kBatch).online, Pointwise(FloatNear(1e-6f), expected))
            << hidden.size() << " hidden layers, dueling " << dueling;
      }
    }
  }
}

struct Case {
  NetworkShape shape;
  int batch;
};

class TwoWays : public testing::TestWithParam<Case> {};

// Both ways from one state through a few steps. Adam divides by the gradient's size, so that it
// magnifies a rounding error where the gradient is next to nothing: epsilon is large here.
TEST_P(TwoWays, AgreeWithLibTorchsAutogradAndAdam) {
  const auto& [shape, batch] = GetParam();
  for (const bool double_q : {true, false}) {
    for (const double norm_max : {0.01, 1e6}) {
      DqnSettings dqn;
      dqn.double_q = double_q;
      dqn.gradient_norm_max = norm_max;
      dqn.adam_epsilon = 1e-3;
      TdState state = initial_td_state(initial_parameters(shape, 5, Phase::kMop));
      state.target = initial_parameters(shape, 6, Phase::kMop);
      const auto by_hand = cpu_networks(shape, dqn, state);
      const auto by_torch = torch_networks(shape, dqn, Device::kCpu, state);
      for (std::uint64_t i = 0; i < 4; ++i) {
        const std::vector<float> rows = numbers(batch * RowLayout{shape.observations}.stride(), i);
        const std::vector<float> q_gradient = numbers(batch * shape.actions, 100 + i);
        const BatchQValues q = by_hand->forward(rows, batch);
        const BatchQValues expected = by_torch->forward(rows, batch);
        expect_near(q.online, expected.online, "Q");
        expect_near(q.online_next, expected.online_next, "next Q");
        expect_near(q.target_next, expected.target_next, "target's next Q");
        const double norm = by_torch->step(q_gradient, 1e-2);
        EXPECT_NEAR(by_hand->step(q_gradient, 1e-2), norm, 1e-5 * norm);
        if (i == 1) {
          by_hand->copy_to_target();
          by_torch->copy_to_target();
        }
        const TdState after = by_hand->state();
        const TdState expected_after = by_torch->state();
        EXPECT_EQ(after.updates, expected_after.updates);
        expect_near(after.online, expected_after.online, "online");
        expect_near(after.target, expected_after.target, "target");
        expect_near(after.mean_gradient, expected_after.mean_gradient, "mean");
        expect_near(after.mean_squared_gradient, expected_after.mean_squared_gradient, "squared");
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, TwoWays,
                         testing::Values(Case{{5, {}, 3, false}, 1}, Case{{5, {}, 3, true}, 7},
                                         Case{{43, {64, 64}, 18, false}, 64},
                                         Case{{43, {64, 64}, 18, true}, 64},
                                         Case{{20, {33}, 3, false}, 31},
                                         Case{{20, {17, 40, 9}, 3, true}, 128}));

TEST(TorchNetworks, TakeOverAStateAndChangeNothingByIt) {
  const NetworkShape shape{4, {8}, 3, true};
  TdState state = initial_td_state(initial_parameters(shape, 5, Phase::kMop));
  state.mean_gradient.assign(state.online.size(), 0.5F);
  state.mean_squared_gradient.assign(state.online.size(), 0.25F);
  state.updates = 12;
  EXPECT_EQ(torch_networks(shape, {}, Device::kCpu, state)->state(), state);
  EXPECT_EQ(cpu_networks(shape, {}, state)->state(), state);
}

TEST(TorchNetworks, RefuseADeviceThatIsNotThere) {
  try {
    torch_networks({2, {}, 2, false}, {}, Device::kCuda, initial_td_state(numbers(6, 0)));
    GTEST_SKIP() << "it is there";
  } catch (const Failure& failure) {
    EXPECT_THAT(failure.what(), HasSubstr("finds no CUDA device"));
  }
}

}  // namespace
}  // namespace corridor::learner
