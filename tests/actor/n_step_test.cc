// SPDX-License-Identifier: Apache-2.0
#include "actor/n_step.h"

#include <gtest/gtest.h>

#include <cmath>

namespace corridor::actor {
namespace {

const RowLayout kLayout{1};

NStepBuilder builder_of(int n, double reward_scale = 1.0) {
  DqnSettings dqn;
  dqn.n_step = n;
  dqn.gamma = 0.5;
  dqn.risk_gamma = 0.25;
  dqn.reward_scale = reward_scale;
  return {kLayout, dqn};
}

struct Row {
  float observation, next, action, n_step_return, discount;
  bool operator==(const Row&) const = default;
};

std::vector<Row> rows_of(NStepBuilder& builder) {
  const std::vector<float> flat = builder.take_rows();
  std::vector<Row> rows;
  for (std::size_t i = 0; i < flat.size(); i += kLayout.stride()) {
    rows.push_back({flat[i], flat[i + 1], flat[i + 2], flat[i + 3], flat[i + 4]});
  }
  return rows;
}

void push(NStepBuilder& builder, float observation, int action, double reward,
          bool terminal = false) {
  builder.push(std::vector<float>{observation}, action,
               {.reward = reward, .cost = 0.0, .terminal = terminal});
}

TEST(NStepBuilder, CompletesARowNStepsLater) {
  NStepBuilder builder = builder_of(2);
  push(builder, 10, 1, 1.0);
  push(builder, 11, 2, 2.0);
  EXPECT_TRUE(rows_of(builder).empty());
  push(builder, 12, 3, 4.0);
  EXPECT_EQ(rows_of(builder), (std::vector<Row>{{10, 12, 1, 2.0, 0.25}}));
}

TEST(NStepBuilder, EndsEveryPendingRowWithoutBootstrapAtATerminalStep) {
  NStepBuilder builder = builder_of(3);
  push(builder, 10, 1, 1.0);
  push(builder, 11, 2, 2.0, true);
  EXPECT_EQ(rows_of(builder), (std::vector<Row>{{10, 0, 1, 2.0, 0}, {11, 0, 2, 2.0, 0}}));
}

TEST(NStepBuilder, KeepsStepsAfterATerminalOneApartFromThoseBefore) {
  NStepBuilder builder = builder_of(2);
  push(builder, 10, 1, 1.0, true);
  push(builder, 20, 2, 3.0);
  push(builder, 21, 2, 5.0);
  push(builder, 22, 2, 0.0);
  EXPECT_EQ(rows_of(builder), (std::vector<Row>{{10, 0, 1, 1.0, 0}, {20, 22, 2, 5.5, 0.25}}));
}

TEST(NStepBuilder, BootstrapsFromTheLastObservationWhenCutOff) {
  NStepBuilder builder = builder_of(3);
  push(builder, 10, 1, 1.0);
  push(builder, 11, 2, 2.0);
  builder.cut_off(std::vector<float>{99});
  EXPECT_EQ(rows_of(builder), (std::vector<Row>{{10, 99, 1, 2.0, 0.25}, {11, 99, 2, 2.0, 0.5}}));
}

TEST(NStepBuilder, ScalesRewardsOnce) {
  NStepBuilder builder = builder_of(1, 0.1);
  push(builder, 10, 1, 5.0, true);
  EXPECT_EQ(rows_of(builder), (std::vector<Row>{{10, 0, 1, 0.5, 0}}));
}

TEST(NStepBuilder, DiscountsCostsByTheirOwnFactorAndDoesNotScaleThem) {
  NStepBuilder builder = builder_of(3, 0.1);
  builder.push(std::vector<float>{10}, 0, {.reward = 1.0});
  builder.push(std::vector<float>{11}, 0, {.reward = 1.0});
  builder.push(std::vector<float>{12}, 0, {.reward = 1.0});
  builder.push(std::vector<float>{13}, 0, {.reward = 1.0, .cost = 1.0, .terminal = true});
  const std::vector<float> rows = builder.take_rows();
  const float expected[][2] = {{0.0f, 1.0f / 64}, {1.0f / 16, 0.0f}, {0.25f, 0.0f}, {1.0f, 0.0f}};
  ASSERT_EQ(rows.size(), std::size(expected) * kLayout.stride());
  for (std::size_t i = 0; i < std::size(expected); ++i) {
    const float* row = rows.data() + i * kLayout.stride();
    EXPECT_EQ(row[kLayout.risk_return()], expected[i][0]) << i;
    EXPECT_EQ(row[kLayout.risk_discount()], expected[i][1]) << i;
  }
}

}  // namespace
}  // namespace corridor::actor
