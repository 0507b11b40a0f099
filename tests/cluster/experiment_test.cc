// SPDX-License-Identifier: Apache-2.0
#include "cluster/experiment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/config/config_values.h"
#include "proto/run/run_directory.h"
#include "proto/system/files.h"
#include "tests/support/failure_of.h"
#include "tests/support/some_manifest.h"
#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// What is refused before anything is trained.
class ExperimentDirectory : public testing::Test {
 protected:
  ExperimentDirectory() {
    write_file(temporary_.path() / "a.toml", "");
    write_file(file_, text_);
  }
  std::string failure() {
    return failure_of([&] { experiment({file_, directory_}, "corridor"); });
  }
  // A run of the experiment's that began with other settings.
  void begin_run(const RunConfig& config) {
    std::filesystem::create_directories(directory_ / "runs");
    write_file(directory_ / "experiment.toml", text_);
    const RunDirectory run = RunDirectory::create(directory_ / "runs" / "first-1");
    write_file(run.config(), to_toml(config));
    write_manifest(run, testing_support::some_manifest(config));
  }

  testing_support::TemporaryDirectory temporary_;
  std::filesystem::path file_ = temporary_.path() / "experiment.toml";
  std::filesystem::path directory_ = temporary_.path() / "results";
  const std::string text_ =
      "planners = [\"rules\"]\n"
      "training_seeds = [1]\n"
      "evaluation_seeds = [7]\n"
      "evaluation_steps = 10\n"
      "[[training]]\n"
      "name = \"first\"\n"
      "scenario = \"a.toml\"\n"
      "evaluate_in = [\"a.toml\"]\n";
};

TEST_F(ExperimentDirectory, OfAnotherExperimentIsRefused) {
  std::filesystem::create_directories(directory_);
  write_file(directory_ / "experiment.toml", text_ + "# of yesterday\n");
  EXPECT_THAT(failure(), HasSubstr("holds another experiment"));
}

TEST_F(ExperimentDirectory, WithSomethingElseInItIsRefusedAndNotTouched) {
  std::filesystem::create_directories(directory_);
  write_file(directory_ / "precious", "");
  EXPECT_THAT(failure(), HasSubstr("has something else than an experiment in it"));
  EXPECT_EQ(testing_support::names_in(directory_), std::vector<std::string>{"precious"});
}

TEST_F(ExperimentDirectory, WhoseRunBeganWithOtherSettingsIsRefusedByKey) {
  RunConfig other;
  other.dqn[0].gamma = 0.5;
  begin_run(other);
  EXPECT_THAT(failure(), AllOf(HasSubstr("was trained with mop.gamma = 0.5"),
                               HasSubstr("now says 0.97"), HasSubstr("move it away")));
  EXPECT_EQ(read_file(directory_ / "experiment.toml"), text_);
}

TEST_F(ExperimentDirectory, IsNotBegunWithoutACore) {
  EXPECT_THAT(failure_of([&] {
                experiment({file_, directory_, 0}, "corridor");
              }),
              HasSubstr("--jobs 0"));
  EXPECT_FALSE(std::filesystem::exists(directory_));
}

}  // namespace
}  // namespace corridor::cluster
