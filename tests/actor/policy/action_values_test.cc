// SPDX-License-Identifier: Apache-2.0
#include "actor/policy/action_values.h"

#include <gtest/gtest.h>

namespace corridor::policy {
namespace {

DqnSettings settings(double risk_weight) {
  DqnSettings dqn;
  dqn.hidden = {1};
  dqn.risk_weight = risk_weight;
  return dqn;
}

// One hidden unit h = relu(x), then the two actions' factors of h and biases.
std::vector<float> network(float factor_0, float factor_1, float bias_0, float bias_1) {
  return {1, 0, factor_0, factor_1, bias_0, bias_1};
}

std::vector<float> both(std::vector<float> first, const std::vector<float>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

const std::vector<float> kOne = {1};

TEST(ActionValues, AreTheQValuesWithoutARiskNetwork) {
  ActionValues planner(settings(0.0), {1, 2}, network(1, 2, 0.5, 0));
  const auto values = planner.values(kOne);
  EXPECT_EQ(std::vector<float>(values.begin(), values.end()), (std::vector<float>{1.5, 2}));
  EXPECT_EQ(planner.greedy(kOne), 1);
}

TEST(ActionValues, TakeTheWeightedRiskOff) {
  ActionValues planner(settings(2.0), {1, 2}, both(network(1, 2, 0.5, 0), network(0, 1, 0.25, 0)));
  const auto values = planner.values(kOne);
  EXPECT_EQ(std::vector<float>(values.begin(), values.end()), (std::vector<float>{1.0, 0}));
  EXPECT_EQ(planner.greedy(kOne), 0);
}

TEST(ActionValues, CountANegativeRiskAsNone) {
  ActionValues planner(settings(2.0), {1, 2}, both(network(1, 2, 0, 0), network(0, 0, -1, 0.5)));
  const auto values = planner.values(kOne);
  EXPECT_EQ(std::vector<float>(values.begin(), values.end()), (std::vector<float>{1, 1}));
  EXPECT_EQ(planner.greedy(kOne), 0) << "the lowest of equals";
}

// observation, next, action, return, discount, risk return, risk discount
const std::vector<float> kRows = {1, 3, 0, 0.5f, 0.9f, 0.0f, 0.8f, 2, 0, 1, 1.0f, 0.0f, 1.0f, 0.0f};

TEST(ActionValues, GiveTheTdErrorsOfHandWorkedRows) {
  ActionValues planner(settings(0.0), {1, 2}, network(1, 2, 0, 0));
  const auto errors = planner.td_errors(kRows);
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_NEAR(errors[0], 4.9f, 1e-6);  // |0.5 + 0.9 * 6 - 1|
  EXPECT_NEAR(errors[1], 3.0f, 1e-6);  // |1 - 4|
}

TEST(ActionValues, AddTheRisksTdErrorsAtTheSameNextAction) {
  // At 3: Q 3, 6 and risk 0.5, 3.5: with weight 2 action 0 is taken.
  ActionValues planner(settings(2.0), {1, 2}, both(network(1, 2, 0, 0), network(0, 1, 0.5, 0.5)));
  const auto errors = planner.td_errors(kRows);
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_NEAR(errors[0], 2.2f + 0.1f, 1e-6);  // |0.5 + 0.9 * 3 - 1| + |0.8 * 0.5 - 0.5|
  EXPECT_NEAR(errors[1], 3.0f + 1.5f, 1e-6);  // |1 - 4| + |1 - 2.5|
}

}  // namespace
}  // namespace corridor::policy
