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
  EXPECT_THAT(plan[2].argv, ElementsAre("/bin/x/corridor-actor", "train", root_, "--index", "0"));
  EXPECT_THAT(plan[3].argv, ElementsAre("/bin/x/corridor-actor", "train", root_, "--index", "1"));
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

// The task that corridor-actor understands of what is started.
ActorTask task_of(const ProcessPlan& process) {
  std::vector<const char*> argv;
  for (const std::string& text : process.argv) argv.push_back(text.c_str());
  EXPECT_EQ(process.argv.front(), "/p/corridor-actor");
  return std::get<ActorCommand>(parse_actor_command(static_cast<int>(argv.size()), argv.data()))
      .task;
}

TEST_F(Plan, TrajectoriesAndOtherNetworksAreAskedForOnlyWhereTheyAreGiven) {
  const EvaluationJob job{"rules+mop", 7, 100};
  EvaluateTask task{"rules+mop", 7, 100};
  EXPECT_EQ(task_of(evaluation_process(job, directory_, directory_, "/p", "")), ActorTask(task));
  task.fcd = "/tmp/fcd";
  EXPECT_EQ(task_of(evaluation_process(job, directory_, directory_, "/p", "/tmp/fcd")),
            ActorTask(task));
  const RunDirectory other = RunDirectory::create(directory_.root() / "other");
  task = {"rules+mop", 7, 100, root_};
  EXPECT_EQ(task_of(evaluation_process(job, other, directory_, "/p", "")), ActorTask(task));
}

TEST_F(Plan, ALookBackIsToldItsLimits) {
  EXPECT_EQ(task_of(hindsight_process({"rules+mop", 7, 100}, {3, 1000}, directory_, "/p")),
            ActorTask(LookBackTask{"rules+mop", 7, {3, 1000}}));
}

}  // namespace
}  // namespace corridor::cluster
