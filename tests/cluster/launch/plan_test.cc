// SPDX-License-Identifier: Apache-2.0
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
  const auto plan = training_plan(settings, directory_);
  ASSERT_EQ(plan.size(), 4u);
  EXPECT_THAT(plan[0].argv, ElementsAre(program_path("corridor-replay"), root_));
  EXPECT_THAT(plan[1].argv, ElementsAre(program_path("corridor-learner"), root_));
  EXPECT_THAT(plan[2].argv,
              ElementsAre(program_path("corridor-actor"), "train", root_, "--index", "0"));
  EXPECT_THAT(plan[3].argv,
              ElementsAre(program_path("corridor-actor"), "train", root_, "--index", "1"));
  EXPECT_EQ(plan[1].name, kLearnerName);
}

TEST_F(Plan, EveryProcessHasANameAndALogOfItsOwn) {
  RunSettings settings;
  settings.actors = 12;
  std::set<std::string> names, logs;
  for (const ProcessPlan& process : training_plan(settings, directory_)) {
    names.insert(process.name);
    logs.insert(process.log.string());
  }
  EXPECT_EQ(names.size(), 14u);
  EXPECT_EQ(logs.size(), 14u);
}

TEST_F(Plan, EveryPlannerIsEvaluatedOnEverySeed) {
  EXPECT_THAT(evaluation_tasks({"rules", "sumo"}, {7, 8}, 100),
              ElementsAre(EvaluateTask{"rules", 7, 100}, EvaluateTask{"rules", 8, 100},
                          EvaluateTask{"sumo", 7, 100}, EvaluateTask{"sumo", 8, 100}));
}

TEST_F(Plan, AnActorIsToldItsTaskAndLogsByItsName) {
  const ProcessPlan process =
      actor_process("a", LookBackTask{"rules+mop", 7, {3, 1000}}, directory_);
  EXPECT_EQ(process.log, directory_.log("a"));
  EXPECT_FALSE(process.replaceable || process.ends_by_itself);
  std::vector<const char*> argv;
  for (const std::string& text : process.argv) argv.push_back(text.c_str());
  const auto parsed = parse_actor_command(static_cast<int>(argv.size()), argv.data());
  EXPECT_EQ(std::get<ActorCommand>(parsed).task,
            ActorTask(LookBackTask{"rules+mop", 7, {3, 1000}}));
}

}  // namespace
}  // namespace corridor::cluster
