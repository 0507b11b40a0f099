// SPDX-License-Identifier: Apache-2.0
#include "learner/td_loss.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "proto/base/failure.h"

namespace corridor::learner {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr int kThreeActions = 3;
const RowLayout kRow{1};

// observation, next observation, action, return, discount, and those of the risk
std::vector<float> row(float action, float n_step_return, float discount) {
  return {0.0f, 0.0f, action, n_step_return, discount, -7.0f, 0.5f};
}
const ReturnColumns kReward{kRow.n_step_return(), kRow.discount()};
const ReturnColumns kRisk{kRow.risk_return(), kRow.risk_discount()};

struct OneRow {
  std::vector<float> values = row(1, 0.5f, 0.9f);
  std::vector<float> weights = {1.0f};
  std::vector<float> online = {0.0f, 1.0f, 0.0f};
  std::vector<float> target_next = {4.0f, 0.0f, 2.0f};

  std::vector<std::size_t> next_actions = {2};

  TdLoss loss(double huber_delta = 1.0, const ReturnColumns& columns = kReward) const {
    return td_loss(values, kRow, columns, weights, {online, {}, target_next}, next_actions,
                   kThreeActions, huber_delta);
  }
};

TEST(TdLoss, BootstrapsFromTheTargetsValueOfTheNextAction) {
  OneRow example;
  // 1.0 - (0.5 + 0.9 * 2.0)
  EXPECT_THAT(example.loss().priorities, ElementsAre(testing::FloatNear(1.3f, 1e-6f)));
  example.next_actions = {0};  // 1.0 - (0.5 + 0.9 * 4.0)
  EXPECT_THAT(example.loss().priorities, ElementsAre(testing::FloatNear(3.1f, 1e-6f)));
}

TEST(TdLoss, ReadsTheReturnAndTheDiscountOfItsColumns) {
  // 1.0 - (-7.0 + 0.5 * 2.0)
  EXPECT_THAT(OneRow{}.loss(1.0, kRisk).priorities, ElementsAre(testing::FloatNear(7.0f, 1e-6f)));
}

TEST(GreedyActions, TakeTheFirstOfTheLargestQValues) {
  const std::vector<float> q = {1, 3, 2, 5, 4, 5};
  EXPECT_THAT(greedy_actions(q, {}, 2.0, kThreeActions), ElementsAre(1u, 0u));
}

TEST(GreedyActions, TakeTheWeightedRiskOffWhereItIsPositive) {
  const std::vector<float> q = {1, 3, 2, 5, 4, 5};
  const std::vector<float> risk = {0, 1, 0, -9, -1, -2};
  EXPECT_THAT(greedy_actions(q, risk, 2.0, kThreeActions), ElementsAre(2u, 0u));
}

TEST(TdLoss, DoesNotBootstrapWhereTheDiscountIsZero) {
  OneRow example;
  example.values = row(1, 0.25f, 0.0f);
  EXPECT_THAT(example.loss().priorities, ElementsAre(0.75f));
}

TEST(TdLoss, IsQuadraticInsideHubersDeltaAndLinearOutside) {
  OneRow example;
  example.values = row(1, 0.6f, 0.0f);  // error 0.4
  EXPECT_NEAR(example.loss(0.5).loss, 0.5 * 0.4 * 0.4, 1e-7);
  EXPECT_NEAR(example.loss(0.5).q_gradient[1], 0.4, 1e-7);
  example.values = row(1, 3.0f, 0.0f);  // error -2
  EXPECT_NEAR(example.loss(0.5).loss, 0.5 * (2.0 - 0.25), 1e-7);
  EXPECT_NEAR(example.loss(0.5).q_gradient[1], -0.5, 1e-7);
}

TEST(TdLoss, GivesAGradientToTheActionsTakenOnly) {
  EXPECT_THAT(OneRow{}.loss().q_gradient, ElementsAre(0.0f, -1.0f, 0.0f));
}

TEST(TdLoss, WeighsEachRowsLossAndGradientButNotItsPriority) {
  OneRow two;
  two.values = row(1, 0.6f, 0.0f);
  const std::vector<float> second = row(0, 0.2f, 0.0f);
  two.values.insert(two.values.end(), second.begin(), second.end());
  two.weights = {1.0f, 0.25f};
  two.online = {0.0f, 1.0f, 0.0f, 1.0f, 0.0f, 0.0f};
  two.target_next = std::vector<float>(6, 0.0f);
  two.next_actions = {0, 0};
  const TdLoss loss = two.loss();
  EXPECT_NEAR(loss.loss, 0.5 * (0.5 * 0.16 + 0.25 * 0.5 * 0.64), 1e-7);
  EXPECT_NEAR(loss.q_gradient[1], 0.5 * 0.4, 1e-7);
  EXPECT_NEAR(loss.q_gradient[3], 0.5 * 0.25 * 0.8, 1e-7);
  EXPECT_THAT(loss.priorities,
              ElementsAre(testing::FloatNear(0.4f, 1e-6f), testing::FloatNear(0.8f, 1e-6f)));
  EXPECT_NEAR(loss.q_value, 1.0, 1e-7);
}

TEST(TdLoss, GradientIsTheLosssDerivative) {
  OneRow example;
  for (const double delta : {0.5, 5.0}) {
    const float step = 1e-2f;
    OneRow up = example, down = example;
    up.online[1] += step;
    down.online[1] -= step;
    EXPECT_NEAR((up.loss(delta).loss - down.loss(delta).loss) / (2.0 * step),
                example.loss(delta).q_gradient[1], 1e-5);
  }
}

TEST(TdLoss, RefusesAnActionThatThePlannerDoesNotHave) {
  for (const float action : {3.0f, -1.0f, std::numeric_limits<float>::quiet_NaN()}) {
    OneRow example;
    example.values = row(action, 0.0f, 0.0f);
    EXPECT_THROW(example.loss(), Failure) << action;
  }
}

TEST(TdLoss, SaysWhenTrainingHasDiverged) {
  OneRow example;
  example.online[1] = std::numeric_limits<float>::infinity();
  try {
    example.loss();
    FAIL() << "no Failure";
  } catch (const Failure& failure) {
    EXPECT_THAT(failure.what(), HasSubstr("diverged"));
  }
}

}  // namespace
}  // namespace corridor::learner
