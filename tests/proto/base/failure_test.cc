// SPDX-License-Identifier: Apache-2.0
#include "proto/base/failure.h"

#include <gtest/gtest.h>

namespace corridor {
namespace {

TEST(Failures, AreFormatted) {
  EXPECT_STREQ(Failure("{} of {}", 3, "four").what(), "3 of four");
  EXPECT_STREQ(Failure("as {} is").what(), "as {} is");
}

TEST(Failures, AHeldCheckEvaluatesItsConditionOnceAndNothingElse) {
  int evaluated = 0;
  CORRIDOR_CHECK(++evaluated == 1, "{}", ++evaluated);
  EXPECT_EQ(evaluated, 1);
}

TEST(FailuresDeathTest, AFailedCheckPrintsPlaceConditionAndValues) {
  const int lanes = 3;
  EXPECT_DEATH(CORRIDOR_CHECK(lanes == 4, "{} lanes", lanes),
               "failure_test.cc:[0-9]+: check failed: lanes == 4: 3 lanes");
  EXPECT_DEATH(CORRIDOR_CHECK(lanes == 4), "check failed: lanes == 4");
}

}  // namespace
}  // namespace corridor
