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

}  // namespace
}  // namespace corridor::cluster
