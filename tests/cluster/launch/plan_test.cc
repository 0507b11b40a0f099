#include "cluster/launch/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "proto/run/run_directory.h"
#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

class Plan : public testing::Test {
 protected:
  testing_support::TemporaryDirectory temporary_;
  RunDirectory directory_ = RunDirectory::create(temporary_.path() / "run");
  std::string root_ = directory_.root();
};

TEST_F(Plan, TrainingIsOneReplayServerOneLearnerAndTheActorsInThisOrder) {
  RunSettings settings;
  settings.actors = 2;
  const auto plan = training_plan(settings, directory_, "/bin/x");
  ASSERT_EQ(plan.size(), 4u);
  EXPECT_THAT(plan[0].argv, ElementsAre("/bin/x/corridor-replay", root_));
  EXPECT_THAT(plan[1].argv, ElementsAre("/bin/x/corridor-learner", root_));
  EXPECT_THAT(plan[2].argv, ElementsAre("/bin/x/corridor-actor", root_, "--index", "0"));
  EXPECT_THAT(plan[3].argv, ElementsAre("/bin/x/corridor-actor", root_, "--index", "1"));
  EXPECT_EQ(plan[1].name, kLearnerName);
}

TEST_F(Plan, EveryProcessHasANameAndALogOfItsOwn) {
  RunSettings settings;
  settings.actors = 12;
  std::set<std::string> names, logs;
  for (const ProcessPlan& process : training_plan(settings, directory_, "/bin/x")) {
    names.insert(process.name);
    logs.insert(process.log.string());
  }
  EXPECT_EQ(names.size(), 14u);
  EXPECT_EQ(logs.size(), 14u);
}

TEST_F(Plan, EveryPlannerIsEvaluatedOnEverySeed) {
  EXPECT_THAT(evaluation_jobs({"rules", "sumo"}, {7, 8}, 100),
              ElementsAre(EvaluationJob{"rules", 7, 100}, EvaluationJob{"rules", 8, 100},
                          EvaluationJob{"sumo", 7, 100}, EvaluationJob{"sumo", 8, 100}));
}

TEST_F(Plan, TrajectoriesAreWrittenOnlyWhenAskedFor) {
  const EvaluationJob job{"rules+mop", 7, 100};
  EXPECT_THAT(evaluation_process(job, directory_, directory_, "/p", "").argv,
              ElementsAre("/p/corridor-actor", root_, "--evaluate", "rules+mop", "--seed", "7",
                          "--steps", "100"));
  EXPECT_THAT(evaluation_process(job, directory_, directory_, "/p", "/tmp/fcd").argv,
              ElementsAre("/p/corridor-actor", root_, "--evaluate", "rules+mop", "--seed", "7",
                          "--steps", "100", "--fcd", "/tmp/fcd"));
  const RunDirectory other = RunDirectory::create(directory_.root() / "other");
  EXPECT_THAT(evaluation_process(job, other, directory_, "/p", "").argv,
              ElementsAre("/p/corridor-actor", other.root().string(), "--evaluate", "rules+mop",
                          "--seed", "7", "--steps", "100", "--networks", root_));
  EXPECT_EQ(evaluation_file(job, directory_), directory_.evaluation() / "rules+mop_7.json");
}

TEST_F(Plan, ALookBackIsToldItsLimits) {
  const EvaluationJob job{"rules+mop", 7, 100};
  EXPECT_THAT(hindsight_process(job, {4, 1000}, directory_, "/p").argv,
              ElementsAre("/p/corridor-actor", root_, "--look-back", "rules+mop", "--seed", "7",
                          "--actions", "4", "--attempts", "1000"));
  EXPECT_EQ(hindsight_file(job, directory_), directory_.hindsight() / "rules+mop_7.json");
}

}  // namespace
}  // namespace corridor::cluster
