// SPDX-License-Identifier: Apache-2.0
#include "cluster/train.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cluster/launch/run_lock.h"
#include "proto/base/failure.h"
#include "proto/config/config_values.h"
#include "proto/config/run_config.h"
#include "proto/run/checkpoints.h"
#include "proto/run/run_directory.h"
#include "proto/settings/schedule.h"
#include "proto/system/files.h"
#include "tests/support/some_manifest.h"
#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

class Training : public testing::Test {
 protected:
  Training() { write_file(scenario_, to_toml(RunConfig())); }

  // The checkpoint's files are made up: the replay server or the learner says which it misses.
  // Where the programs have not been built, that is what is said.
  void expect_refused_by_its_programs() {
    EXPECT_THAT(
        [&] { resume({.run = run_}, "corridor"); },
        ThrowsMessage<Failure>(AnyOf(
            AllOf(HasSubstr("manifest.json is damaged: it names no"), HasSubstr("safetensors")),
            HasSubstr("is the build complete?"))));
  }

  testing_support::TemporaryDirectory temporary_;
  std::filesystem::path scenario_ = temporary_.path() / "scenario.toml";
  std::filesystem::path run_ = temporary_.path() / "run";
};

TEST_F(Training, AWrongScenarioOrOverrideLeavesNoRunDirectory) {
  const auto refused = [&](TrainOptions options, const char* why) {
    options.run = run_;
    EXPECT_THAT([&] { train(options, "corridor"); }, ThrowsMessage<Failure>(HasSubstr(why)));
  };
  refused({.scenario = temporary_.path() / "missing.toml"}, "missing.toml");
  refused({.scenario = scenario_, .settings = {"mop.stops=3"}}, "mop.stops");
  refused({.scenario = scenario_, .actors = 0}, "run.actors");
  EXPECT_FALSE(std::filesystem::exists(run_));
}

TEST_F(Training, WithoutSumoNoRunDirectoryIsLeft) {
  const std::string path = getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  EXPECT_THAT([&] { train({.scenario = scenario_, .run = run_}, "corridor"); },
              ThrowsMessage<Failure>(HasSubstr("netconvert")));
  setenv("PATH", path.c_str(), 1);
  EXPECT_FALSE(std::filesystem::exists(run_));
}

TEST_F(Training, ARunDirectoryThatExistsIsRefusedAndNotTouched) {
  std::filesystem::create_directory(run_);
  write_file(run_ / "precious", "content");
  EXPECT_THAT([&] { train({.scenario = scenario_, .run = run_}, "corridor"); },
              ThrowsMessage<Failure>(HasSubstr("exists already")));
  EXPECT_EQ(read_file(run_ / "precious"), "content");
}

// A run directory as after training, without the training.
RunDirectory make_run(const std::filesystem::path& root, std::uint64_t rounds_done) {
  RunDirectory directory = RunDirectory::create(root);
  write_file(directory.config(), to_toml(RunConfig()));
  write_manifest(directory, testing_support::some_manifest(RunConfig()));
  Checkpoints(directory.checkpoints()).begin(rounds_done - 1);
  Checkpoints(directory.checkpoints()).commit(rounds_done - 1, 2);
  return directory;
}

TEST_F(Training, ACompleteRunIsNotResumedAndThatIsNoError) {
  make_run(run_, Schedule(RunConfig()).rounds());
  testing::internal::CaptureStdout();
  EXPECT_EQ(resume({.run = run_}, "bin/corridor"), 0);
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              AllOf(HasSubstr("is complete"), HasSubstr("bin/corridor evaluate " + run_.string())));
}

TEST_F(Training, ARunThatIsGoingOnIsNotResumed) {
  const RunDirectory directory = make_run(run_, 1);
  const Descriptor lock = lock_run(directory);
  EXPECT_THAT([&] { resume({.run = run_}, "corridor"); },
              ThrowsMessage<Failure>(HasSubstr("is going on")));
}

TEST_F(Training, ASettingThatTheResultDependsOnIsNotChangedInTheMiddle) {
  const RunDirectory directory = make_run(run_, Schedule(RunConfig()).rounds());
  EXPECT_THAT([&] { resume({.run = run_, .settings = {"mop.gamma=0.5"}}, "corridor"); },
              ThrowsMessage<Failure>(AllOf(HasSubstr("mop.gamma = 0.5"), HasSubstr("began with"))));
  EXPECT_EQ(read_file(directory.config()), to_toml(RunConfig()));
  RunConfig changed;
  changed.run.actors = 3;
  write_file(directory.config(), to_toml(changed));
  EXPECT_THAT([&] { resume({.run = run_}, "corridor"); },
              ThrowsMessage<Failure>(HasSubstr("run.actors = 3: the run began with 2")));
}

TEST_F(Training, OthersAreAppliedAndStay) {
  const RunDirectory directory = make_run(run_, Schedule(RunConfig()).rounds());
  testing::internal::CaptureStdout();
  EXPECT_EQ(resume({.run = run_, .settings = {"schedule.checkpoints_kept=7"}}, "corridor"), 0);
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              HasSubstr("schedule.checkpoints_kept = 7, where the run began with 2"));
  EXPECT_EQ(load_run_config(directory.config()).schedule.checkpoints_kept, 7);
}

TEST_F(Training, ADamagedCheckpointIsNamedAndTheOneBeforeIsUsed) {
  const RunDirectory directory = make_run(run_, 5);
  const std::filesystem::path newer = Checkpoints(directory.checkpoints()).begin(7);
  write_file(newer / kLearnerFile, "state");
  Checkpoints(directory.checkpoints()).commit(7, 2);
  write_file(directory.checkpoints() / "7" / kLearnerFile, "stale");
  write_file(directory.root() / "config.toml.tmp-77", "half");
  testing::internal::CaptureStdout();
  expect_refused_by_its_programs();
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              AllOf(HasSubstr("7/learner.safetensors is damaged"),
                    HasSubstr("goes on from the checkpoint of: MoP, 5 of 2736 rounds")));
  EXPECT_FALSE(std::filesystem::exists(directory.root() / "config.toml.tmp-77"));
}

TEST_F(Training, ResumeSaysWhereItGoesOnAndWhatItRepeats) {
  const RunDirectory directory = make_run(run_, 5);
  write_file(directory.metrics(kLearnerName), R"({"phase":"MoP","round":6,"step":3584})"
                                              "\n");
  testing::internal::CaptureStdout();
  expect_refused_by_its_programs();
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              HasSubstr("goes on from the checkpoint of: MoP, 5 of 2736 rounds, 2,560 of 1,400,832 "
                        "steps; 1,024 steps after it are repeated"));
}

}  // namespace
}  // namespace corridor::cluster
