// SPDX-License-Identifier: Apache-2.0
#include "cluster/check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/base/failure.h"
#include "proto/config/config_values.h"
#include "proto/run/run_directory.h"
#include "proto/system/files.h"
#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(Check, SaysWhatAScenarioThatNetconvertAcceptsComesToAndLeavesNothing) {
  const testing_support::TemporaryDirectory temporary;
  const auto file = temporary.path() / "scenario.toml";
  RunConfig config;
  config.dqn[0].capacity = 1'000'000;
  write_file(file, to_toml(config));
  const auto before = std::filesystem::current_path();
  setenv("TMPDIR", temporary.path().c_str(), 1);
  testing::internal::CaptureStdout();
  EXPECT_EQ(check(file, {}), 0);
  unsetenv("TMPDIR");
  EXPECT_THAT(
      testing::internal::GetCapturedStdout(),
      AllOf(HasSubstr(file.string() + ": ok"), HasSubstr("3 lanes of 3.2 m, 20.0 km, 50 km/h"),
            HasSubstr("1,000,000 steps in 1,954 rounds; 40 observations, 18 actions"),
            // 40 observations: 83 floats a row.
            HasSubstr("replay of 1,000,000 rows, 324 MiB")));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(temporary.path()), {}), 1);
}

TEST(Check, WarnsOfWhatMakesNoSenseAndTakesOverrides) {
  const testing_support::TemporaryDirectory temporary;
  const auto file = temporary.path() / "scenario.toml";
  write_file(file, "");
  testing::internal::CaptureStdout();
  EXPECT_EQ(check(file, {"mop.steps=3000"}), 0);
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              HasSubstr("warning     the MoP would learn nothing"));
}

TEST(Check, RefusesAWrongScenario) {
  const testing_support::TemporaryDirectory temporary;
  const auto file = temporary.path() / "scenario.toml";
  write_file(file, "[road]\nlanes = -1\n");
  EXPECT_THROW(check(file, {}), Failure);
}

}  // namespace
}  // namespace corridor::cluster
