#include "actor/n_step.h"

#include <gtest/gtest.h>

#include <cmath>

namespace corridor::actor {
namespace {

constexpr double kGamma = 0.5;
const RowLayout kLayout{1};

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
  builder.push(std::vector<float>{observation}, action, reward, terminal);
}

TEST(NStepBuilder, CompletesARowNStepsLater) {
  NStepBuilder builder(kLayout, 2, kGamma, 1.0);
  push(builder, 10, 1, 1.0);
  push(builder, 11, 2, 2.0);
  EXPECT_TRUE(rows_of(builder).empty());
  push(builder, 12, 3, 4.0);
  EXPECT_EQ(rows_of(builder), (std::vector<Row>{{10, 12, 1, 2.0, 0.25}}));
}

TEST(NStepBuilder, EndsEveryPendingRowWithoutBootstrapAtATerminalStep) {
  NStepBuilder builder(kLayout, 3, kGamma, 1.0);
  push(builder, 10, 1, 1.0);
  push(builder, 11, 2, 2.0, true);
  EXPECT_EQ(rows_of(builder), (std::vector<Row>{{10, 0, 1, 2.0, 0}, {11, 0, 2, 2.0, 0}}));
}

TEST(NStepBuilder, KeepsStepsAfterATerminalOneApartFromThoseBefore) {
  NStepBuilder builder(kLayout, 2, kGamma, 1.0);
  push(builder, 10, 1, 1.0, true);
  push(builder, 20, 2, 3.0);
  push(builder, 21, 2, 5.0);
  push(builder, 22, 2, 0.0);
  EXPECT_EQ(rows_of(builder), (std::vector<Row>{{10, 0, 1, 1.0, 0}, {20, 22, 2, 5.5, 0.25}}));
}

TEST(NStepBuilder, BootstrapsFromTheLastObservationWhenCutOff) {
  NStepBuilder builder(kLayout, 3, kGamma, 1.0);
  push(builder, 10, 1, 1.0);
  push(builder, 11, 2, 2.0);
  builder.cut_off(std::vector<float>{99});
  EXPECT_EQ(rows_of(builder), (std::vector<Row>{{10, 99, 1, 2.0, 0.25}, {11, 99, 2, 2.0, 0.5}}));
}

TEST(NStepBuilder, ScalesRewardsOnce) {
  NStepBuilder builder(kLayout, 1, kGamma, 0.1);
  push(builder, 10, 1, 5.0, true);
  EXPECT_EQ(rows_of(builder), (std::vector<Row>{{10, 0, 1, 0.5, 0}}));
}

}  // namespace
}  // namespace corridor::actor
