// SPDX-License-Identifier: Apache-2.0
#include "proto/run/actor_task.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/failure_of.h"
#include "tests/support/temporary_directory.h"

namespace corridor {
namespace {

using testing::HasSubstr;

std::variant<ActorCommand, int> parsed(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), kActorProgram);
  std::vector<const char*> argv;
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  return parse_actor_command(static_cast<int>(argv.size()), argv.data());
}

const ActorTask kTasks[] = {
    TrainTask{3},
    EvaluateTask{"rules+mop", 1002, 40'000},
    EvaluateTask{"sumo", ~std::uint64_t{0}, 1, "runs/a b", "fcd"},
    RedriveTask{"runs/a/evaluation/episodes/rules_7_0.json"},
    RedriveTask{"x.json", "fcd.xml"},
    TraceTask{"rules_7_0.json"},
    TraceTask{"rules_7_0.json", "runs/b"},
    DriveTask{"hierarchical", 7, 12, 60},
    DriveTask{"hierarchical", 7, 12, 60, "runs/b"},
    LookBackTask{"hierarchical", 7, {2, 500}},
};

TEST(ActorTask, IsParsedAsItWasAsked) {
  const testing_support::TemporaryDirectory temporary;
  const RunDirectory run = RunDirectory::create(temporary.path() / "run");
  for (const ActorTask& task : kTasks) {
    const auto command = std::get<ActorCommand>(parsed(argv_of(task, run)));
    EXPECT_EQ(command.run, run.root());
    EXPECT_TRUE(command.task == task) << task.index() << ": " << argv_of(task, run).front();
  }
}

TEST(ActorTask, IsOneAndComplete) {
  EXPECT_THAT(failure_of([] { parsed({}); }), HasSubstr("subcommand is required"));
  EXPECT_THAT(failure_of([] { parsed({"fly", "run"}); }), HasSubstr("subcommand is required"));
  EXPECT_THAT(failure_of([] { parsed({"train", "run"}); }), HasSubstr("--index"));
  EXPECT_THAT(failure_of([] { parsed({"train", "--index", "0"}); }), HasSubstr("RUN"));
  for (const char* index : {"one", "-1", "2147483648"}) {
    EXPECT_THAT(failure_of([&] {
                  parsed({"train", "run", "--index", index});
                }),
                HasSubstr("is no whole number from 0 to 2147483647"));
  }
  EXPECT_THAT(failure_of([] {
                parsed({"train", "run", "--index", "0", "--seed", "1"});
              }),
              HasSubstr("--seed"));
}

TEST(ActorTask, GivenTwiceIsRefused) {
  EXPECT_NE(failure_of([] {
              parsed({"train", "run", "--index", "0", "redrive", "run", "--episode", "a.json"});
            }),
            "no failure");
  EXPECT_NE(failure_of([] {
              parsed({"redrive", "run", "--episode", "a.json", "train", "run", "--index", "0"});
            }),
            "no failure");
}

TEST(ActorTask, HelpIsAnExitStatus) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(std::get<int>(parsed({"--help"})), 0);
  EXPECT_THAT(testing::internal::GetCapturedStdout(), HasSubstr("look-back"));
}

TEST(StepCount, IsReadFromLinesOfThatFormOnly) {
  EXPECT_EQ(parse_step_count(step_count(1200, 40'000)), 1200);
  for (const char* text : {"", "/", "12", "12/", "/40", "12/40 ", "a 12/40", "12/40/7"}) {
    EXPECT_FALSE(parse_step_count(text)) << text;
  }
}

}  // namespace
}  // namespace corridor
