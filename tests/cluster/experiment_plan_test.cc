#include "cluster/experiment_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/system/files.h"
#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

using testing::ElementsAre;

class ExperimentPlan : public testing::Test {
 protected:
  ExperimentPlan() {
    write_file(scenario_, "[traffic]\nvehicles_max = 17\n");
    TrainingArm first, on;
    first.name = "first";
    first.scenario = on.scenario = scenario_;
    first.planners = on.planners = {"hierarchical", "rules", "sumo"};
    first.training_seeds = {3, 1};
    first.settings = {"mop.gamma=0.5", "run.actors=4"};
    on.name = "on";
    on.from = "first";
    on.training_seeds = {1};
    experiment_.trainings = {first, on};
    experiment_.evaluation_seeds = {7, 8};
    experiment_.evaluation_steps = 1000;
    runs_ = runs_of(experiment_, "e");
  }

  testing_support::TemporaryDirectory temporary_;
  std::filesystem::path scenario_ = temporary_.path() / "a.toml";
  Experiment experiment_;
  std::vector<TrainingRun> runs_;
};

TEST_F(ExperimentPlan, TrainsEverySeedOfEveryTrainingInADirectoryOfItsOwn) {
  ASSERT_EQ(runs_.size(), 3u);
  EXPECT_EQ(runs_[0].name(), "first-3");
  EXPECT_EQ(runs_[0].root, "e/runs/first-3");
  EXPECT_EQ(runs_[1].name(), "first-1");
  EXPECT_EQ(runs_[2].name(), "on-1");
  EXPECT_EQ(runs_[0].config.run.seed, 3u);
  EXPECT_EQ(runs_[0].config.run.actors, 4);
  EXPECT_EQ(runs_[0].config.traffic.vehicles_max, 17);
  EXPECT_EQ(runs_[2].config.run.actors, RunConfig{}.run.actors);
}

TEST_F(ExperimentPlan, TrainsWithItsSettingsAndFromTheNetworksOfTheSameSeed) {
  EXPECT_THAT(train_command(runs_[0], "corridor"),
              ElementsAre("corridor", "train", scenario_.string(), "--run", "e/runs/first-3",
                          "--seed", "3", "--set", "mop.gamma=0.5", "--set", "run.actors=4"));
  EXPECT_THAT(train_command(runs_[2], "corridor"),
              ElementsAre("corridor", "train", scenario_.string(), "--run", "e/runs/on-1", "--seed",
                          "1", "--from", "e/runs/first-1"));
}

TEST_F(ExperimentPlan, DrivesWhatLearnsNothingBesideTheFirstSeedOnly) {
  EXPECT_THAT(
      jobs_of(runs_[0], experiment_, WorldKind::kKinematic),
      ElementsAre(EvaluationJob{"hierarchical", 7, 1000}, EvaluationJob{"hierarchical", 8, 1000},
                  EvaluationJob{"rules", 7, 1000}, EvaluationJob{"rules", 8, 1000},
                  EvaluationJob{"sumo", 7, 1000}, EvaluationJob{"sumo", 8, 1000}));
  EXPECT_THAT(
      jobs_of(runs_[1], experiment_, WorldKind::kKinematic),
      ElementsAre(EvaluationJob{"hierarchical", 7, 1000}, EvaluationJob{"hierarchical", 8, 1000}));
}

TEST_F(ExperimentPlan, LeavesOutSumosDriverWhereTheCarHasDynamics) {
  for (const EvaluationJob& job : jobs_of(runs_[0], experiment_, WorldKind::kRigid)) {
    EXPECT_NE(job.planner, "sumo");
  }
}

}  // namespace
}  // namespace corridor::cluster
