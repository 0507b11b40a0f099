// SPDX-License-Identifier: Apache-2.0
#include "cluster/commands.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/base/failure.h"
#include "proto/system/program.h"

namespace corridor::cluster {
namespace {

using testing::HasSubstr;

struct Outcome {
  int status = -1;
  std::string output;
  std::string failure;
};

Outcome run(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "bin/corridor");
  Outcome outcome;
  testing::internal::CaptureStdout();
  try {
    outcome.status = run_command(static_cast<int>(arguments.size()), arguments.data());
  } catch (const Failure& failure) {
    outcome.failure = failure.what();
  }
  outcome.output = testing::internal::GetCapturedStdout();
  return outcome;
}

constexpr const char* kCommands[] = {"train",  "resume",      "evaluate", "hindsight",
                                     "report", "fingerprint", "redrive",  "check"};

TEST(Commands, EveryOneHasHelpWithExamplesAndAVersion) {
  const Outcome overview = run({"--help"});
  EXPECT_EQ(overview.status, 0);
  EXPECT_EQ(run({"--version"}).output, std::string(kVersion) + "\n");
  for (const char* command : kCommands) {
    EXPECT_THAT(overview.output, HasSubstr(command));
    const Outcome help = run({command, "--help"});
    EXPECT_EQ(help.status, 0) << command;
    EXPECT_THAT(help.output, HasSubstr(std::string("Examples:\n  corridor ") + command));
    EXPECT_EQ(run({command, "--version"}).output, std::string(kVersion) + "\n") << command;
  }
}

TEST(Commands, AWrongCommandLineIsOneLineThatNamesWhatIsWrongAndWhereHelpIs) {
  const std::vector<std::pair<std::vector<const char*>, const char*>> wrong = {
      {{}, "subcommand"},
      {{"fly"}, "there is no command 'fly', but train, resume"},
      {{"train", "a.toml", "--run", ""}, "its value is empty"},
      {{"train", "a.toml"}, "--run"},
      {{"train", "--run", "x"}, "SCENARIO"},
      {{"train", "a.toml", "--run", "x", "--actors", "two"}, "--actors"},
      {{"train", "a.toml", "--run", "x", "--seed", "-1"}, "--seed"},
      {{"train", "a.toml", "--run", "x", "--fast"}, "--fast"},
      {{"evaluate", "run", "--seeds", "1,b"}, "--seeds"},
      {{"evaluate", "run", "--seeds", "1,-2"}, "--seeds"},
      {{"evaluate", "run", "--seeds", "18446744073709551616"}, "--seeds"},
      {{"evaluate", "run", "--steps", "0"}, "--steps"},
      {{"evaluate", "run", "--steps", "99999999999"}, "--steps"},
      {{"evaluate", "run", "--jobs", "0"}, "--jobs"},
      {{"drive", "run", "--number", "-1"}, "'-1' is no whole number from 0 to"},
      {{"drive", "run", "--seed", "1.5"}, "--seed"},
      {{"report"}, "DIR"},
      {{"hindsight", "run", "--actions", "0"}, "--actions"},
      {{"hindsight", "run", "--attempts", "0"}, "--attempts"},
      {{"redrive", "run"}, "EPISODE"},
  };
  for (const auto& [arguments, named] : wrong) {
    const Outcome outcome = run(arguments);
    EXPECT_THAT(outcome.failure, HasSubstr(named));
    EXPECT_THAT(outcome.failure, HasSubstr("see bin/corridor"));
    EXPECT_EQ(outcome.failure.find('\n'), std::string::npos) << outcome.failure;
  }
}

TEST(Commands, OptionsMayStandBeforeTheFileAndDoNotSwallowIt) {
  // Both get as far as reading the file: the command line was understood.
  EXPECT_THAT(run({"train", "--run", "/nowhere/run", "--set", "run.seed=1", "--set", "run.actors=2",
                   "/nowhere/a.toml"})
                  .failure,
              HasSubstr("cannot read /nowhere/a.toml"));
  EXPECT_THAT(
      run({"evaluate", "--seeds", "1,2", "--planners", "rules,sumo", "/nowhere/run"}).failure,
      HasSubstr("/nowhere/run is no run directory"));
}

TEST(Commands, ADirectoryThatIsNoRunIsRefusedByEveryCommandThatNeedsOne) {
  for (const char* command : {"resume", "evaluate", "fingerprint"}) {
    EXPECT_THAT(run({command, "/nowhere"}).failure, HasSubstr("/nowhere is no run directory"));
  }
  EXPECT_THAT(run({"report", "/nowhere"}).failure, HasSubstr("no run directory"));
  EXPECT_THAT(run({"redrive", "/nowhere", "rules_1_1"}).failure, HasSubstr("no run directory"));
}

}  // namespace
}  // namespace corridor::cluster
