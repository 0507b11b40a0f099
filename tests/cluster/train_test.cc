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

// Of the manifest that make_run writes.
RunVersions as_trained() { return testing_support::some_manifest(RunConfig()).versions; }

class Training : public testing::Test {
 protected:
  Training() { write_file(scenario_, to_toml(RunConfig())); }

  // The checkpoint's files are made up: the replay server or the learner says which it misses.
  // Where the programs have not been built, that is what is said.
  void expect_refused_by_its_programs(const std::vector<std::string>& settings = {}) {
    EXPECT_THAT(
        [&] { resume({.run = run_, .settings = settings}, "corridor", as_trained); },
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
  EXPECT_EQ(resume({.run = run_}, "bin/corridor", as_trained), 0);
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              AllOf(HasSubstr("is complete"), HasSubstr("bin/corridor evaluate " + run_.string())));
}

TEST_F(Training, ARunThatIsGoingOnIsNotResumed) {
  const RunDirectory directory = make_run(run_, 1);
  const Descriptor lock = lock_folder(directory.root());
  EXPECT_THAT([&] { resume({.run = run_}, "corridor", as_trained); },
              ThrowsMessage<Failure>(HasSubstr("is going on")));
}

TEST_F(Training, ASettingThatTheResultDependsOnIsNotChangedInTheMiddle) {
  const RunDirectory directory = make_run(run_, Schedule(RunConfig()).rounds());
  EXPECT_THAT([&] { resume({.run = run_, .settings = {"mop.gamma=0.5"}}, "corridor", as_trained); },
              ThrowsMessage<Failure>(AllOf(HasSubstr("mop.gamma = 0.5"), HasSubstr("began with"))));
  EXPECT_EQ(read_file(directory.config()), to_toml(RunConfig()));
  RunConfig changed;
  changed.run.actors = 3;
  write_file(directory.config(), to_toml(changed));
  EXPECT_THAT([&] { resume({.run = run_}, "corridor", as_trained); },
              ThrowsMessage<Failure>(HasSubstr("run.actors = 3: the run began with 2")));
}

TEST_F(Training, APhaseMayGoOnForLongerWhereNoLaterOneHasBegun) {
  const std::uint64_t mop_rounds = Schedule(RunConfig()).rounds_of(Phase::kMop);
  const RunDirectory directory = make_run(run_, mop_rounds - 1);
  const RunConfig before;
  testing::internal::CaptureStdout();
  expect_refused_by_its_programs({"mop.steps=2000000"});
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              AllOf(HasSubstr("the phase goes on"),
                    HasSubstr("mop.steps = 2000000, where it was 1000000")));
  const RunConfig now = load_run_config(directory.config());
  EXPECT_EQ(now.phase(Phase::kMop).steps, 2'000'000);
  EXPECT_EQ(now.phase(Phase::kMop).annealing_steps, before.phase(Phase::kMop).steps);
  EXPECT_EQ(now.phase(Phase::kBp).annealing_steps, 0);
  const RunManifest manifest = read_manifest(directory);
  ASSERT_EQ(manifest.continuations.value().size(), 1u);
  EXPECT_EQ(manifest.continuations->front().round, mop_rounds - 1);
  EXPECT_EQ(manifest.config, to_toml(now));
}

TEST_F(Training, APhaseThatIsOverIsNotMadeLongerAndNoneShorter) {
  const std::uint64_t mop_rounds = Schedule(RunConfig()).rounds_of(Phase::kMop);
  make_run(run_, mop_rounds);
  for (const char* setting : {"mop.steps=2000000", "bp.steps=3000", "mop.steps=2000"}) {
    EXPECT_THAT([&] { resume({.run = run_, .settings = {setting}}, "corridor", as_trained); },
                ThrowsMessage<Failure>(HasSubstr("its result depends on it")))
        << setting;
  }
}

TEST_F(Training, OtherLibrariesAreRefusedByNameUnlessTheyAreAllowedAndThenRecorded) {
  const RunDirectory directory = make_run(run_, Schedule(RunConfig()).rounds());
  const auto other = [] {
    RunVersions versions = as_trained();
    versions.libtorch = "2.6.0";
    return versions;
  };
  EXPECT_THAT([&] { resume({.run = run_}, "corridor", other); },
              ThrowsMessage<Failure>(AllOf(HasSubstr("libtorch 1.13.0"), HasSubstr("2.6.0"),
                                           HasSubstr("--allow-other-bits"))));
  EXPECT_EQ(read_manifest(directory).continuations, std::nullopt);
  testing::internal::CaptureStdout();
  EXPECT_EQ(resume({.run = run_, .allow_other_bits = true}, "corridor", other), 0);
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              HasSubstr("libtorch 2.6.0, where it was 1.13.0"));
  const RunManifest manifest = read_manifest(directory);
  ASSERT_EQ(manifest.continuations.value().size(), 1u);
  EXPECT_EQ(manifest.versions, as_trained()) << "it began with them";
  testing::internal::CaptureStdout();
  EXPECT_EQ(resume({.run = run_}, "corridor", other), 0) << "it is now trained with these";
  testing::internal::GetCapturedStdout();
}

TEST_F(Training, OthersAreAppliedAndStay) {
  const RunDirectory directory = make_run(run_, Schedule(RunConfig()).rounds());
  testing::internal::CaptureStdout();
  EXPECT_EQ(
      resume({.run = run_, .settings = {"schedule.checkpoints_kept=7"}}, "corridor", as_trained),
      0);
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
