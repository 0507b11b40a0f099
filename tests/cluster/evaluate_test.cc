// SPDX-License-Identifier: Apache-2.0
#include "cluster/evaluate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "proto/system/files.h"
#include "tests/support/failure_of.h"
#include "tests/support/temporary_directory.h"
#include "tests/support/untrained_run.h"

namespace corridor::cluster {
namespace {

using testing::HasSubstr;

class Evaluation : public testing::Test {
 protected:
  std::string failure_in(EvaluateOptions options) {
    options.run = directory_.root();
    return failure_of([&] { evaluate(options); });
  }
  std::string failure_to_write(const std::filesystem::path& json) {
    return failure_in({.planners = {"rules"}, .json = json});
  }

  testing_support::TemporaryDirectory temporary_;
  RunDirectory directory_ = testing_support::untrained_run(temporary_.path() / "run");
};

TEST_F(Evaluation, WrongOptionsAreRefusedBeforeAnythingIsDriven) {
  EXPECT_THAT(failure_in({.planners = {"human"}}), HasSubstr("no planner 'human'"));
  EXPECT_THAT(failure_in({.planners = {"rules", "rules"}}), HasSubstr("rules is given twice"));
  EXPECT_THAT(failure_in({.planners = {"rules"}, .seeds = {5, 6, 5}}),
              HasSubstr("5 is given twice"));
  EXPECT_THAT(failure_in({.planners = {"rules"}, .steps = 0}), HasSubstr("--steps 0"));
  EXPECT_THAT(failure_in({.planners = {"rules"}, .jobs = 0}), HasSubstr("--jobs 0"));
  EXPECT_THAT(failure_in({}), HasSubstr("no checkpoint yet"));
}

TEST_F(Evaluation, ATableThatCannotBeWrittenIsRefusedAndTheReasonGiven) {
  EXPECT_EQ(failure_to_write("/nowhere/table.json"),
            "cannot write /nowhere/table.json: No such file or directory");
  EXPECT_THAT(failure_to_write(temporary_.path()), HasSubstr("it is a directory"));
  const std::filesystem::path file = temporary_.path() / "file", closed = temporary_.path() / "c";
  write_file(file, "");
  EXPECT_THAT(failure_to_write(file / "table.json"), HasSubstr("Not a directory"));
  EXPECT_THAT(failure_to_write(file / "below" / "table.json"), HasSubstr("Not a directory"));
  if (geteuid() == 0) GTEST_SKIP() << "root may write anywhere";
  std::filesystem::create_directory(closed);
  std::filesystem::permissions(closed, std::filesystem::perms::owner_read);
  EXPECT_THAT(failure_to_write(closed / "table.json"), HasSubstr("Permission denied"));
}

}  // namespace
}  // namespace corridor::cluster
