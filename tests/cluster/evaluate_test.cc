#include "cluster/evaluate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/base/failure.h"
#include "proto/config/run_config.h"
#include "proto/run/checkpoints.h"
#include "proto/run/tensor_file.h"
#include "proto/settings/schedule.h"
#include "proto/system/files.h"
#include "tests/support/temporary_directory.h"
#include "tests/support/untrained_run.h"

namespace corridor::cluster {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

class Evaluation : public testing::Test {
 protected:
  // As after the given number of rounds.
  void put_checkpoint(std::uint64_t rounds_done) {
    Checkpoints(directory_.checkpoints()).begin(rounds_done - 1);
    Checkpoints(directory_.checkpoints()).commit(rounds_done - 1, 2);
  }
  std::string failure_of(EvaluateOptions options) {
    options.run = directory_.root();
    try {
      evaluate(options);
    } catch (const Failure& failure) {
      return failure.what();
    }
    return "no failure";
  }

  testing_support::TemporaryDirectory temporary_;
  RunConfig config_;
  RunDirectory directory_ = testing_support::untrained_run(temporary_.path() / "run", config_);
};

TEST_F(Evaluation, PlannersWithoutLearnedPartsNeedNoCheckpoint) {
  EXPECT_NO_THROW(check_can_drive("rules", directory_, config_));
  EXPECT_NO_THROW(check_can_drive("sumo", directory_, config_));
  for (const char* planner : {"hierarchical", "rules+mop", "bp+rules"}) {
    EXPECT_THAT([&] { check_can_drive(planner, directory_, config_); },
                ThrowsMessage<Failure>(HasSubstr("no checkpoint yet")));
  }
}

TEST_F(Evaluation, PlannersWithALearnedBpWaitForItsPhase) {
  const std::uint64_t mop_rounds = Schedule(config_).rounds_of(Phase::kMop);
  put_checkpoint(mop_rounds);
  EXPECT_NO_THROW(check_can_drive("rules+mop", directory_, config_));
  EXPECT_THAT([&] { check_can_drive("hierarchical", directory_, config_); },
              ThrowsMessage<Failure>(HasSubstr("has trained the MoP only")));
  put_checkpoint(mop_rounds + 1);
  EXPECT_NO_THROW(check_can_drive("hierarchical", directory_, config_));
  EXPECT_NO_THROW(check_can_drive("bp+rules", directory_, config_));
}

TEST_F(Evaluation, AnotherScenarioHasItsWorldAndTheRunsPlanners) {
  const std::filesystem::path scenario = temporary_.path() / "dense.toml";
  write_file(scenario, "[traffic]\nvehicles_max = 17\n[mop]\ngamma = 0.5\n");
  const RunDirectory place = world_directory(directory_, {scenario});
  EXPECT_EQ(place.root(), directory_.root() / "scenarios" / "dense");
  const RunConfig config = load_run_config(place.config());
  EXPECT_EQ(config.traffic.vehicles_max, 17);
  EXPECT_EQ(config.phase(Phase::kMop).gamma, config_.phase(Phase::kMop).gamma);
  EXPECT_TRUE(std::filesystem::exists(place.network()));
  EXPECT_TRUE(std::filesystem::exists(place.routes()));
  EXPECT_EQ(world_directory(directory_, {scenario}).root(), place.root()) << "again";

  write_file(scenario, "[traffic]\nvehicles_max = 18\n");
  EXPECT_THAT([&] { world_directory(directory_, {scenario}); },
              ThrowsMessage<Failure>(HasSubstr("driven with other settings")));
  std::filesystem::remove(place.config());  // as if stopped before it was written
  EXPECT_EQ(load_run_config(world_directory(directory_, {scenario}).config()).traffic.vehicles_max,
            18);
}

TEST_F(Evaluation, AScenarioThatTheNetworksDoNotFitIsRefused) {
  const std::filesystem::path scenario = temporary_.path() / "wide.toml";
  write_file(scenario,
             "[road]\nlanes = 4\n[bp_reward]\nthresholds_mps = [9.0, 10.0, 11.0, 12.0]\n");
  EXPECT_THAT([&] { world_directory(directory_, {scenario}); },
              ThrowsMessage<Failure>(HasSubstr("has 4 lanes")));
}

TEST_F(Evaluation, ASettingThatIsTheTrainedPlannersOwnIsRefused) {
  const std::filesystem::path scenario = temporary_.path() / "dense.toml";
  write_file(scenario, "[traffic]\nvehicles_max = 17\n");
  EXPECT_THAT(
      [&] {
        world_directory(directory_, {scenario, {"planner.side_clearance_m=0.3"}});
      },
      ThrowsMessage<Failure>(HasSubstr("planner.side_clearance_m belongs to the training")));
  EXPECT_NO_THROW(world_directory(directory_, {scenario, {"planner.corridor_change_s=2"}}));
}

TEST_F(Evaluation, WrongOptionsAreRefusedBeforeAnythingIsDriven) {
  EXPECT_THAT(failure_of({.planners = {"human"}}), HasSubstr("no planner 'human'"));
  EXPECT_THAT(failure_of({.planners = {"rules", "rules"}}), HasSubstr("rules is given twice"));
  EXPECT_THAT(failure_of({.planners = {"rules"}, .seeds = {5, 6, 5}}),
              HasSubstr("5 is given twice"));
  EXPECT_THAT(failure_of({.planners = {"rules"}, .steps = 0}), HasSubstr("--steps 0"));
  EXPECT_THAT(failure_of({.planners = {"rules"}, .jobs = 0}), HasSubstr("--jobs 0"));
  EXPECT_THAT(failure_of({.planners = {"rules"}, .json = "/nowhere/table.json"}),
              HasSubstr("cannot write /nowhere/table.json"));
  EXPECT_THAT(failure_of({}), HasSubstr("no checkpoint yet"));
}

TEST_F(Evaluation, AnEpisodeIsFoundByFileOrByName) {
  const auto file = directory_.episodes() / "rules+mop_1001_3.json";
  write_file(file, "{}");
  EXPECT_EQ(find_episode(directory_, "rules+mop_1001_3"), file);
  EXPECT_EQ(find_episode(directory_, file.string()), file);
  EXPECT_THAT([&] { find_episode(directory_, "rules_1_1"); },
              ThrowsMessage<Failure>(HasSubstr(directory_.episodes().string())));
}

}  // namespace
}  // namespace corridor::cluster
