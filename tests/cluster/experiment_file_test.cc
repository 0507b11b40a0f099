// SPDX-License-Identifier: Apache-2.0
#include "cluster/experiment_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/base/failure.h"
#include "proto/run/run_directory.h"
#include "proto/system/files.h"
#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string kHead =
    "planners = [\"hierarchical\", \"rules\"]\n"
    "training_seeds = [1, 2]\n"
    "evaluation_seeds = [1002]\n"
    "evaluation_steps = 1_000\n";
const std::string kTraining =
    "[[training]]\n"
    "name = \"first\"\n"
    "scenario = \"a.toml\"\n"
    "evaluate_in = [\"a.toml\", \"b.toml dynamics.friction=0.5\"]\n";

class ExperimentFile : public testing::Test {
 protected:
  ExperimentFile() {
    write_file(temporary_.path() / "a.toml", "");
    write_file(temporary_.path() / "b.toml", "[traffic]\nvehicles_max = 17\n");
  }
  Experiment load(const std::string& text) {
    write_file(file_, text);
    return load_experiment(file_);
  }
  std::string failure_of(const std::string& text) {
    try {
      load(text);
    } catch (const Failure& failure) {
      EXPECT_THAT(failure.what(), HasSubstr(file_.parent_path().string()));
      return failure.what();
    }
    return "no failure";
  }

  testing_support::TemporaryDirectory temporary_;
  std::filesystem::path file_ = temporary_.path() / "experiment.toml";
};

TEST_F(ExperimentFile, SaysWhatIsTrainedAndWhereItIsEvaluated) {
  const Experiment experiment = load(kHead + kTraining +
                                     "[[training]]\n"
                                     "name = \"second\"\n"
                                     "scenario = \"b.toml\"\n"
                                     "settings = [\"mop.gamma=0.5\", \"mop.steps=5000\"]\n"
                                     "evaluate_in = [\"a.toml\"]\n"
                                     "planners = [\"rules+mop\"]\n"
                                     "training_seeds = [7]\n");
  EXPECT_THAT(experiment.evaluation_seeds, ElementsAre(1002));
  EXPECT_EQ(experiment.evaluation_steps, 1000);
  ASSERT_EQ(experiment.trainings.size(), 2u);
  const TrainingArm& first = experiment.trainings[0];
  EXPECT_EQ(first.name, "first");
  EXPECT_EQ(first.scenario, temporary_.path() / "a.toml");
  ASSERT_EQ(first.evaluate_in.size(), 2u);
  EXPECT_EQ(first.evaluate_in[0].scenario, temporary_.path() / "a.toml");
  EXPECT_EQ(first.evaluate_in[1].scenario, temporary_.path() / "b.toml");
  EXPECT_EQ(first.evaluate_in[0].name(""), "a");
  EXPECT_EQ(first.evaluate_in[1].name(""), "b+friction=0.5");
  EXPECT_THAT(first.evaluate_in[1].settings, ElementsAre("dynamics.friction=0.5"));
  EXPECT_THAT(first.planners, ElementsAre("hierarchical", "rules"));
  EXPECT_THAT(first.training_seeds, ElementsAre(1, 2));
  EXPECT_TRUE(first.settings.empty());
  const TrainingArm& second = experiment.trainings[1];
  EXPECT_THAT(second.settings, ElementsAre("mop.gamma=0.5", "mop.steps=5000"));
  EXPECT_THAT(second.planners, ElementsAre("rules+mop"));
  EXPECT_THAT(second.training_seeds, ElementsAre(7));
}

TEST_F(ExperimentFile, AScenariosPathMayHaveSpaces) {
  std::filesystem::create_directory(temporary_.path() / "my clone, ü");
  write_file(temporary_.path() / "my clone, ü" / "c.toml", "");
  const Experiment experiment = load(
      kHead +
      "[[training]]\n"
      "name = \"x\"\n"
      "scenario = \"my clone, ü/c.toml\"\n"
      "evaluate_in = [\"my clone, ü/c.toml\", \"my clone, ü/c.toml  run.seed=4 road.lanes=3 \"]\n");
  const auto& worlds = experiment.trainings[0].evaluate_in;
  ASSERT_EQ(worlds.size(), 2u);
  for (const auto& world : worlds) {
    EXPECT_EQ(world.scenario, temporary_.path() / "my clone, ü" / "c.toml");
  }
  EXPECT_TRUE(worlds[0].settings.empty());
  EXPECT_THAT(worlds[1].settings, ElementsAre("run.seed=4", "road.lanes=3"));
}

TEST_F(ExperimentFile, WhatIsWrongIsNamedWithFileAndKey) {
  EXPECT_THAT(failure_of("planners = "), HasSubstr("not valid TOML"));
  EXPECT_THAT(failure_of(kHead), HasSubstr("[[training]] is missing"));
  EXPECT_THAT(failure_of("training = [1]\n" + kHead), HasSubstr("[[training]] 1 is no table"));
  EXPECT_THAT(failure_of(kTraining), HasSubstr("planners is missing"));
  EXPECT_THAT(failure_of("seeds = 1\n" + kHead + kTraining),
              HasSubstr("unknown key seeds: known are evaluation_seeds"));
  EXPECT_THAT(failure_of(kHead + kTraining + "seed = 1\n"),
              HasSubstr("[[training]] 1: unknown key seed"));
  EXPECT_THAT(failure_of(kHead + kTraining + kTraining),
              HasSubstr("another one of the name first"));
  EXPECT_THAT(failure_of(kHead + kTraining + "planners = [\"human\"]\n"),
              HasSubstr("no planner 'human'"));
  EXPECT_THAT(failure_of(kHead + kTraining + "training_seeds = []\n"),
              HasSubstr("training_seeds = []: must be a list with something in it"));
  EXPECT_THAT(failure_of(kHead + kTraining + "training_seeds = [1, 1]\n"),
              HasSubstr("names one thing twice"));
  EXPECT_THAT(failure_of(kHead + kTraining + "training_seeds = [-1]\n"),
              HasSubstr("is no whole number"));
  EXPECT_THAT(failure_of(kHead + kTraining + "settings = [\"mop.gama=1\"]\n"),
              HasSubstr("mop.gama"));
  EXPECT_THAT(failure_of(kHead + "[[training]]\nname = \"../x\"\nscenario = \"a.toml\"\n"
                                 "evaluate_in = [\"a.toml\"]\n"),
              HasSubstr("must be letters, digits and _"));
  EXPECT_THAT(failure_of(kHead + "[[training]]\nname = \"x\"\nscenario = \"none.toml\"\n"
                                 "evaluate_in = [\"a.toml\"]\n"),
              HasSubstr("none.toml"));
}

TEST_F(ExperimentFile, ATrainingMayBeginWithTheNetworksOfOneAbove) {
  const auto on = [](const std::string& further) {
    return "[[training]]\nname = \"on\"\nscenario = \"a.toml\"\nevaluate_in = [\"a.toml\"]\n" +
           further;
  };
  EXPECT_EQ(load(kHead + kTraining + on("from = \"first\"\n")).trainings[1].from, "first");
  EXPECT_THAT(failure_of(kHead + kTraining + on("from = \"on\"\n")),
              HasSubstr("must be a training above"));
  EXPECT_THAT(failure_of(kHead + on("from = \"first\"\n") + kTraining),
              HasSubstr("must be a training above"));
  EXPECT_THAT(failure_of(kHead + kTraining + on("from = \"first\"\ntraining_seeds = [2, 3]\n")),
              HasSubstr("that one has no training seed 3"));
}

TEST_F(ExperimentFile, TwoScenariosOfOneNameWouldShareAPlace) {
  std::filesystem::create_directory(temporary_.path() / "other");
  write_file(temporary_.path() / "other" / "a.toml", "");
  EXPECT_THAT(failure_of(kHead + "[[training]]\nname = \"x\"\nscenario = \"a.toml\"\n"
                                 "evaluate_in = [\"a.toml\", \"other/a.toml\"]\n"),
              HasSubstr("two worlds of the name a"));
}

TEST(Experiments, OfTheRepositoryAreRight) {
  const std::filesystem::path folder =
      std::filesystem::path(CORRIDOR_SOURCE_DIR) / "scenarios" / "experiments";
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    EXPECT_NO_THROW(load_experiment(entry.path())) << entry.path();
    ++files;
  }
  EXPECT_GE(files, 2);
}

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
  const auto of = [](const TrainingRun& run, const char* planner, std::uint64_t seed) {
    return EvaluateTask{planner, seed, 1000, run.root};
  };
  EXPECT_THAT(tasks_of(runs_[0], experiment_, WorldKind::kKinematic),
              ElementsAre(of(runs_[0], "hierarchical", 7), of(runs_[0], "hierarchical", 8),
                          of(runs_[0], "rules", 7), of(runs_[0], "rules", 8),
                          of(runs_[0], "sumo", 7), of(runs_[0], "sumo", 8)));
  EXPECT_THAT(tasks_of(runs_[1], experiment_, WorldKind::kKinematic),
              ElementsAre(of(runs_[1], "hierarchical", 7), of(runs_[1], "hierarchical", 8)));
}

TEST_F(ExperimentPlan, LeavesOutSumosDriverWhereTheCarHasDynamics) {
  for (const EvaluateTask& task : tasks_of(runs_[0], experiment_, WorldKind::kRigid)) {
    EXPECT_NE(task.planner, "sumo");
  }
}

}  // namespace
}  // namespace corridor::cluster
