// SPDX-License-Identifier: Apache-2.0
#include "cluster/watch/step_progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "proto/run/actor_task.h"
#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

using testing::HasSubstr;

TEST(StepProgress, AddsUpWhatTheFilesSay) {
  testing_support::TemporaryDirectory temporary;
  const auto first = temporary.path() / "first", second = temporary.path() / "second";
  StepProgress progress("evaluation",
                        {{"rules 7", 1000, 0, first, parse_step_count},
                         {"sumo 7", 1000, 0, second, parse_step_count},
                         {"keep 7", 2000, 2000, temporary.path() / "none", parse_step_count}},
                        100.0);
  EXPECT_THAT(progress.lines(100.0)[0], HasSubstr("50.0 %  2,000 of 4,000 steps"));
  EXPECT_THAT(progress.lines(101.0)[0], Not(HasSubstr("left")))
      << "nothing was done yet that would tell";
  EXPECT_EQ(progress.lines(103.0)[1], "1 of 3 done");

  std::ofstream(first) << "some noise\n"
                       << step_count(250, 1000) << "\n"
                       << step_count(500, 1000) << "\n";
  std::ofstream(second) << step_count(1000, 1000) << "\n";
  progress.tick(101.0);
  EXPECT_THAT(progress.lines(103.0)[0],
              HasSubstr("87.5 %  3,500 of 4,000 steps  500 steps/s  1 s left"));
  EXPECT_EQ(progress.lines(103.0)[1], "2 of 3 done, rules 7: 50 %");
}

TEST(StepProgress, OfNothingIsComplete) {
  EXPECT_THAT(StepProgress("training", {}, 0.0).lines(0.0)[0], HasSubstr("100.0 %"));
  EXPECT_THAT(StepProgress("hindsight", {}, 0.0, "collisions").lines(0.0)[0],
              HasSubstr("0 of 0 collisions"));
}

}  // namespace
}  // namespace corridor::cluster
