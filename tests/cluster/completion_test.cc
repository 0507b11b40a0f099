// SPDX-License-Identifier: Apache-2.0
#include "cluster/completion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "cluster/commands.h"
#include "proto/base/failure.h"
#include "proto/settings/planner_pairs.h"
#include "tests/support/command.h"
#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;
using testing::UnorderedElementsAre;

// What `corridor completion` prints of the whole command line.
std::string printed(const char* format) {
  testing::internal::CaptureStdout();
  const char* const argv[] = {"corridor", "completion", format};
  const int status = run_command(3, argv);
  const std::string output = testing::internal::GetCapturedStdout();
  EXPECT_EQ(status, 0);
  return output;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

class BashCompletion : public testing::Test {
 protected:
  BashCompletion() {
    std::ofstream(folder_.path() / "script") << printed("bash");
    std::filesystem::create_directory(folder_.path() / "runs");
    std::ofstream(folder_.path() / "my scenario.toml") << "";
  }

  // What bash offers for the last of `words`, in a folder with `runs` and `my scenario.toml`.
  std::vector<std::string> offered(const std::string& words) {
    const std::string session = "cd '" + folder_.path().string() +
                                "'; source ./script; COMP_WORDS=(bin/corridor " + words +
                                "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _corridor; "
                                "[ ${#COMPREPLY[@]} = 0 ] || printf '%s\\n' \"${COMPREPLY[@]}\"";
    const auto result = testing_support::run_command({"bash", "--norc", "-u", "-c", session}, 10.0);
    EXPECT_EQ(result.status, 0) << result.output;
    return lines_of(result.output);
  }

  testing_support::TemporaryDirectory folder_;
};

TEST_F(BashCompletion, CommandsByTheirBeginning) {
  EXPECT_THAT(offered("re"), UnorderedElementsAre("resume", "report", "redrive"));
  EXPECT_THAT(offered("''"), Contains("train"));
  EXPECT_THAT(offered("--v"), ElementsAre("--version"));
}

TEST_F(BashCompletion, OptionsAreThoseOfTheCommand) {
  EXPECT_THAT(offered("train --"), Contains("--actors"));
  EXPECT_THAT(offered("train --"), Not(Contains("--planners")));
  EXPECT_THAT(offered("evaluate runs --pl"), ElementsAre("--planners"));
  EXPECT_THAT(offered("fly --"), IsEmpty());
}

TEST_F(BashCompletion, PathsWhereAPathIsMeant) {
  EXPECT_THAT(offered("evaluate ru"), ElementsAre("runs"));
  EXPECT_THAT(offered("train my"), ElementsAre("my scenario.toml"));
  EXPECT_THAT(offered("train --run r"), ElementsAre("runs"));
  EXPECT_THAT(offered("train --run = r"), ElementsAre("runs"));
  EXPECT_THAT(offered("train --actors ''"), IsEmpty());
}

TEST_F(BashCompletion, PlannersAndWorldsByName) {
  EXPECT_THAT(offered("evaluate runs --planners ''"), SizeIs(std::size(kPlannerPairs)));
  EXPECT_THAT(offered("drive runs --planner hier"),
              UnorderedElementsAre("hierarchical", "hierarchical+shield"));
  EXPECT_THAT(offered("evaluate runs --planners rules,su"), ElementsAre("rules,sumo"));
  EXPECT_THAT(offered("drive runs --world s"), ElementsAre("slip"));
  EXPECT_THAT(offered("drive runs --world = s"), ElementsAre("slip"));
  EXPECT_THAT(offered("completion b"), ElementsAre("bash"));
}

TEST(ManPage, TellsEveryCommandWithItsOptionsAndExamples) {
  const std::string page = printed("man");
  EXPECT_TRUE(page.starts_with(".TH CORRIDOR 1 "));
  EXPECT_THAT(page, HasSubstr(".SS \"corridor train [OPTIONS] SCENARIO \\-\\-run PATH\""));
  EXPECT_THAT(page, HasSubstr("\\fB\\-\\-actors\\fR \\fIINT\\fR\n"));
  EXPECT_THAT(page, HasSubstr("corridor check scenarios/paper.toml"));
}

// As roff reads it: a line that begins with a dot is a request, and of those only these.
TEST(ManPage, IsPlainText) {
  for (const std::string& line : lines_of(printed("man"))) {
    EXPECT_FALSE(line.empty());
    EXPECT_NE(line[0], '\'') << line;
    if (line[0] != '.') continue;
    const std::string request = line.substr(0, line.find(' '));
    EXPECT_THAT((std::vector<std::string>{".TH", ".SH", ".SS", ".TP", ".PP", ".br", ".nf", ".fi"}),
                Contains(request));
  }
}

TEST(ManPage, GroffHasNothingToSayOfIt) {
  testing_support::TemporaryDirectory folder;
  std::ofstream(folder.path() / "corridor.1") << printed("man");
  const auto result = testing_support::run_command(
      {"groff", "-man", "-ww", "-z", (folder.path() / "corridor.1").string()}, 30.0);
  if (result.status == 127) GTEST_SKIP() << "groff is not installed";
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.output, "");
}

TEST(Completion, AnotherFormatIsRefused) {
  const char* const argv[] = {"corridor", "completion", "csh"};
  EXPECT_THROW(run_command(3, argv), Failure);
}

}  // namespace
}  // namespace corridor::cluster
