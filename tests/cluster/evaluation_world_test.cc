// SPDX-License-Identifier: Apache-2.0
#include "cluster/evaluation_world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/base/failure.h"
#include "proto/config/config_values.h"
#include "proto/config/run_config.h"
#include "proto/run/checkpoints.h"
#include "proto/settings/schedule.h"
#include "proto/system/files.h"
#include "tests/support/temporary_directory.h"
#include "tests/support/untrained_run.h"

namespace corridor::cluster {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

class EvaluationPlaces : public testing::Test {
 protected:
  // As after the given number of rounds.
  void put_checkpoint(std::uint64_t rounds_done) {
    Checkpoints(directory_.checkpoints()).begin(rounds_done - 1);
    Checkpoints(directory_.checkpoints()).commit(rounds_done - 1, 2);
  }
  EvaluationPlace in(const EvaluationWorld& world) {
    return evaluation_place(directory_.root(), world);
  }
  EvaluationPlace own() { return in({}); }

  testing_support::TemporaryDirectory temporary_;
  RunConfig config_;
  RunDirectory directory_ = testing_support::untrained_run(temporary_.path() / "run", config_);
};

TEST_F(EvaluationPlaces, PlannersWithoutLearnedPartsNeedNoCheckpoint) {
  EXPECT_NO_THROW(check_can_drive("rules", own()));
  EXPECT_NO_THROW(check_can_drive("sumo", own()));
  for (const char* planner : {"hierarchical", "rules+mop", "bp+rules"}) {
    EXPECT_THAT([&] { check_can_drive(planner, own()); },
                ThrowsMessage<Failure>(HasSubstr("no checkpoint yet")));
  }
}

TEST_F(EvaluationPlaces, PlannersWithALearnedBpWaitForItsPhase) {
  const std::uint64_t mop_rounds = Schedule(config_).rounds_of(Phase::kMop);
  put_checkpoint(mop_rounds);
  EXPECT_NO_THROW(check_can_drive("rules+mop", own()));
  EXPECT_THAT([&] { check_can_drive("hierarchical", own()); },
              ThrowsMessage<Failure>(HasSubstr("has trained the MoP only")));
  put_checkpoint(mop_rounds + 1);
  EXPECT_NO_THROW(check_can_drive("hierarchical", own()));
  EXPECT_NO_THROW(check_can_drive("bp+rules", own()));
}

TEST_F(EvaluationPlaces, AnotherScenarioHasItsWorldAndTheRunsPlanners) {
  const std::filesystem::path scenario = temporary_.path() / "dense.toml";
  write_file(scenario, "[traffic]\nvehicles_max = 17\n[mop]\ngamma = 0.5\n");
  const EvaluationPlace place = in({scenario});
  EXPECT_EQ(place.trained.root(), directory_.root());
  EXPECT_EQ(place.directory.root(), directory_.root() / "scenarios" / "dense");
  EXPECT_EQ(place.config.traffic.vehicles_max, 17);
  EXPECT_EQ(place.config.phase(Phase::kMop).gamma, config_.phase(Phase::kMop).gamma);
  EXPECT_EQ(to_toml(load_run_config(place.directory.config())), to_toml(place.config));
  EXPECT_TRUE(std::filesystem::exists(place.directory.network()));
  EXPECT_TRUE(std::filesystem::exists(place.directory.routes()));
  EXPECT_EQ(in({scenario}).directory.root(), place.directory.root()) << "again";

  write_file(scenario, "[traffic]\nvehicles_max = 18\n");
  EXPECT_THAT([&] { in({scenario}); },
              ThrowsMessage<Failure>(HasSubstr("holds results of other settings")));
  std::filesystem::remove(place.directory.manifest());
  EXPECT_THAT([&] { in({scenario}); }, ThrowsMessage<Failure>(HasSubstr("exists already")))
      << "somebody else's";
  std::filesystem::remove_all(place.directory.root());
  EXPECT_EQ(in({scenario}).config.traffic.vehicles_max, 18);
}

TEST_F(EvaluationPlaces, ResultsOfWhatIsNotToBeWrittenToLieElsewhereAndSayWhoseTheyAre) {
  const auto out = temporary_.path() / "out";
  const EvaluationPlace place = evaluation_place(directory_.root(), {}, out);
  EXPECT_EQ(place.directory.root(), out);
  EXPECT_EQ(place.trained.root(), directory_.root());
  EXPECT_EQ(to_toml(place.config), to_toml(config_));
  const EvaluationPlace other =
      evaluation_place(directory_.root(), {{}, {"traffic.vehicles_max=12"}}, out);
  EXPECT_EQ(other.directory.root(), out / "scenarios" / "fake+vehicles_max=12");
  // They can be named in the run's stead, and say which it is.
  for (const auto& results : {out, other.directory.root()}) {
    const EvaluationPlace again = evaluation_place(results, {});
    EXPECT_EQ(again.directory.root(), results);
    EXPECT_EQ(again.trained.root(), std::filesystem::canonical(directory_.root()));
  }
  EXPECT_EQ(evaluation_place(other.directory.root(), {}).config.traffic.vehicles_max, 12);

  const RunDirectory stranger =
      testing_support::untrained_run(temporary_.path() / "stranger", config_);
  RunManifest manifest = read_manifest(stranger);
  manifest.run_id[0] = 'f';
  write_manifest(stranger, manifest);
  EXPECT_THAT([&] { evaluation_place(stranger.root(), {}, out); },
              ThrowsMessage<Failure>(HasSubstr("holds results of another run")));
}

TEST_F(EvaluationPlaces, AScenarioThatTheNetworksDoNotFitIsRefused) {
  const std::filesystem::path scenario = temporary_.path() / "wide.toml";
  write_file(scenario,
             "[road]\nlanes = 4\n[bp_reward]\nthresholds_mps = [9.0, 10.0, 11.0, 12.0]\n");
  EXPECT_THAT([&] { in({scenario}); }, ThrowsMessage<Failure>(HasSubstr("has 4 lanes")));
}

TEST_F(EvaluationPlaces, ASettingThatIsTheTrainedPlannersOwnIsRefused) {
  const std::filesystem::path scenario = temporary_.path() / "dense.toml";
  write_file(scenario, "[traffic]\nvehicles_max = 17\n");
  EXPECT_THAT(
      [&] {
        in({scenario, {"planner.side_clearance_m=0.3"}});
      },
      ThrowsMessage<Failure>(HasSubstr("planner.side_clearance_m belongs to the training")));
  EXPECT_NO_THROW(in({scenario, {"planner.corridor_change_s=2"}}));
}

TEST_F(EvaluationPlaces, AnEpisodeIsFoundByFileOrByName) {
  const auto file = directory_.episodes() / "rules+mop_1001_3.json";
  write_file(file, "{}");
  EXPECT_EQ(find_episode(directory_, "rules+mop_1001_3"), file);
  EXPECT_EQ(find_episode(directory_, file.string()), file);
  EXPECT_THAT([&] { find_episode(directory_, "rules_1_1"); },
              ThrowsMessage<Failure>(HasSubstr(directory_.episodes().string())));
}

TEST_F(EvaluationPlaces, TheRunsOwnWorldIsTheRunItself) {
  const EvaluationPlace place = own();
  EXPECT_EQ(place.directory.root(), directory_.root());
  EXPECT_FALSE(std::filesystem::exists(RunDirectory::scenarios(directory_.root())));
}

TEST_F(EvaluationPlaces, SettingsAloneChangeTheRunsOwnWorld) {
  const EvaluationPlace place = in({{}, {"dynamics.world=slip"}});
  EXPECT_EQ(place.directory.root().filename(), "fake+world=slip");
  EXPECT_EQ(place.config.dynamics.world, WorldKind::kSlip);
  EXPECT_THAT([&] { check_can_drive("sumo", place); },
              ThrowsMessage<Failure>(HasSubstr("dynamics.world = \"slip\"")));
}

}  // namespace
}  // namespace corridor::cluster
