// SPDX-License-Identifier: Apache-2.0
#include "cluster/drive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/support/failure_of.h"
#include "tests/support/fake_run.h"
#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// What is decided before anybody drives. The run was evaluated: rules and random+rules collide once
// each with seed 1002, in episodes that were not recorded.
class Drive : public testing::Test {
 protected:
  Drive() { testing_support::make_fake_run(run_, testing_support::fake_run_config(1)); }
  std::string refusal(DriveOptions options) const {
    options.run = run_;
    const std::string reason = failure_of([&] { drive(options); });
    EXPECT_FALSE(std::filesystem::exists(run_ / "drives"));
    return reason;
  }

  testing_support::TemporaryDirectory temporary_;
  std::filesystem::path run_ = temporary_.path() / "run";
};

TEST_F(Drive, WantsAStretchOfTime) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const auto& [from_s, seconds, interval_s] : {std::array{-1.0, 1.0, 1.0},
                                                    {0.0, 0.0, 1.0},
                                                    {0.0, 1.0, 0.0},
                                                    {0.0, infinity, 1.0},
                                                    {1e300, 1.0, 1.0},
                                                    {0.0, 1.0, infinity},
                                                    {nan, 1.0, 1.0},
                                                    {0.0, nan, 1.0}}) {
    DriveOptions options;
    options.from_s = from_s;
    options.seconds = seconds;
    options.interval_s = interval_s;
    EXPECT_THAT(refusal(options), HasSubstr("give a stretch of time"));
  }
}

TEST_F(Drive, WantsARun) {
  EXPECT_THAT(failure_of([&] { drive({.run = temporary_.path()}); }),
              HasSubstr(temporary_.path().string()));
}

TEST_F(Drive, WantsAPlannerThatCanDrive) {
  EXPECT_THAT(refusal({.planner = "nobody"}), HasSubstr("no planner 'nobody'"));
  EXPECT_THAT(refusal({.planner = "hierarchical"}), HasSubstr("no checkpoint yet"));
}

TEST_F(Drive, WantsAnEpisodeThatWasRecorded) {
  EXPECT_THAT(refusal({.episode = "rules_9_9"}), HasSubstr("there is no episode 'rules_9_9'"));
}

TEST_F(Drive, ShowsCollisionsOfThatPlannerAndSeedOnly) {
  EXPECT_THAT(refusal({.planner = "hierarchical", .collisions = true}),
              AllOf(HasSubstr("has no collision of hierarchical"), HasSubstr("evaluate it first")));
  EXPECT_THAT(refusal({.planner = "rules", .seed = 7, .collisions = true}),
              HasSubstr("has no collision of rules"));
  EXPECT_THAT(refusal({.planner = "rules", .seed = 1002, .collisions = true}),
              HasSubstr("there is no episode 'rules_1002_0'"));
}

}  // namespace
}  // namespace corridor::cluster
