// SPDX-License-Identifier: Apache-2.0
#include "actor/policy/q_network.h"

#include <gtest/gtest.h>

#include <cmath>

#include "learner/td_update.h"
#include "proto/base/random.h"

namespace corridor::policy {
namespace {

std::vector<float> random_floats(std::size_t count, std::uint64_t stream, double scale) {
  std::vector<float> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = static_cast<float>(
        scale * (2.0 * random_unit(stream, Purpose::kInitialWeights, {i}) - 1.0));
  }
  return values;
}

TEST(QNetwork, ComputesAHandWorkedExample) {
  // 2 inputs, 2 hidden, 2 actions: h = relu([x0 - x1 + 1, -x0]), q = [2 h0 + h1, -h0 + 3] + 0.
  QNetwork network({2, {2}, 2, false}, {1, -1, -1, 0, 1, 0, 2, 1, -1, 0, 0, 3});
  const std::vector<float> observation = {3, 1};
  const auto q = network.q_values(observation);
  ASSERT_EQ(q.size(), 2u);
  EXPECT_FLOAT_EQ(q[0], 6.0f);
  EXPECT_FLOAT_EQ(q[1], 0.0f);
}

class AgainstLibTorch : public testing::TestWithParam<NetworkShape> {};

TEST_P(AgainstLibTorch, AgreesToRounding) {
  const NetworkShape shape = GetParam();
  const auto parameters = random_floats(shape.parameters(), 1, 0.3);
  QNetwork network(shape, parameters);
  const auto reference =
      learner::torch_networks(shape, {}, Device::kCpu, learner::initial_td_state(parameters));
  constexpr int kBatch = 64;
  const std::size_t stride = RowLayout{shape.observations}.stride();
  const auto rows = random_floats(stride * kBatch, 2, 1.0);
  const std::span<const float> expected = reference->forward(rows, kBatch).online;
  for (std::size_t i = 0; i < kBatch; ++i) {
    const auto q =
        network.q_values({rows.data() + i * stride, static_cast<std::size_t>(shape.observations)});
    for (std::size_t a = 0; a < q.size(); ++a) {
      EXPECT_NEAR(q[a], expected[i * q.size() + a], 2e-6) << "row " << i << " action " << a;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, AgainstLibTorch,
                         testing::Values(NetworkShape{28, {64, 64}, 9, false},
                                         NetworkShape{24, {64, 64}, 3, true},
                                         NetworkShape{40, {128, 96, 33}, 15, true},
                                         NetworkShape{3, {5}, 2, false}));

}  // namespace
}  // namespace corridor::policy
