// SPDX-License-Identifier: Apache-2.0
// Planners in cars with dynamics of their own, and what people are shown of it.
#include <gmock/gmock.h>

#include "proto/run/run_directory.h"
#include "proto/system/files.h"
#include "tests/e2e/run_support.h"

namespace corridor::e2e {
namespace {

using testing::HasSubstr;

const std::string kScenarios = std::string(CORRIDOR_SOURCE_DIR) + "/scenarios/";

class Drive : public testing::Test {
 protected:
  // The networks that the repository holds, in a directory to write to.
  Drive() {
    std::filesystem::current_path(temporary_.path());  // where results go
    std::filesystem::create_directories(run_);
    // Not what evaluations left beside them.
    for (const char* file : {"config.toml", "manifest.json", "networks.safetensors"})
      std::filesystem::copy(kScenarios + "trained/paper/" + file, run_ / file);
  }
  CommandResult drive(std::vector<std::string> further) const {
    std::vector<std::string> arguments = {kCorridor, "drive", run_, "--out", out_};
    arguments.insert(arguments.end(), further.begin(), further.end());
    return run_command(arguments, kDeadline_s);
  }

  TemporaryDirectory temporary_;
  std::filesystem::path run_ = temporary_.path() / "run", out_ = temporary_.path() / "out",
                        results_ = temporary_.path() / "evaluated" / "run";
};

TEST_F(Drive, EvaluatesTheSameNetworksInEveryWorldBitForBit) {
  for (const char* world : {"kinematic", "rigid", "slip"}) {
    const auto evaluate = [&] {
      const CommandResult result = run_command(
          {kCorridor, "evaluate", run_, "--scenario", kScenarios + "paper_substeps.toml", "--world",
           world, "--planners", "hierarchical,rules", "--steps", "150"},
          kDeadline_s);
      EXPECT_EQ(result.status, 0) << result.output;
      const auto place = results_ / "scenarios" / ("paper_substeps+world=" + std::string(world));
      return read_file(place / "evaluation" / "hierarchical_1002.json");
    };
    EXPECT_EQ(evaluate(), evaluate()) << world;
  }
  const CommandResult by_sumo =
      run_command({kCorridor, "evaluate", run_, "--world", "slip", "--planners", "sumo"}, 60);
  EXPECT_EQ(by_sumo.status, 1);
  EXPECT_THAT(by_sumo.output, HasSubstr("drives without dynamics of its own"));
  const CommandResult moon = run_command({kCorridor, "evaluate", run_, "--world", "moon"}, 60);
  EXPECT_EQ(moon.status, 1);
  EXPECT_THAT(moon.output, HasSubstr("dynamics.world"));
  EXPECT_EQ(lines_in(moon.output), 1) << moon.output;
}

TEST_F(Drive, ShowsAnyEpisodeAndTheCollisionsOfAnEvaluation) {
  const CommandResult fresh = drive({"--seed", "7", "--seconds", "6", "--world", "rigid"});
  ASSERT_EQ(fresh.status, 0) << fresh.output;
  for (const char* file : {"hierarchical_7_0.mp4", "hierarchical_7_0.png", "hierarchical_7_0.html"})
    EXPECT_GT(std::filesystem::file_size(out_ / file), 10'000u) << file;

  const CommandResult evaluated = run_command(
      {kCorridor, "evaluate", run_, "--planners", "left+rules", "--seeds", "3", "--steps", "2000"},
      kDeadline_s);
  ASSERT_EQ(evaluated.status, 0) << evaluated.output;
  const CommandResult again = drive({"--episode", "left+rules_3_0", "--seconds", "5"});
  EXPECT_EQ(again.status, 0) << again.output;
  EXPECT_TRUE(std::filesystem::exists(out_ / "left+rules_3_0.mp4"));
  const CommandResult collisions =
      drive({"--planner", "left+rules", "--collisions", "--most", "2"});
  EXPECT_EQ(collisions.status, 0) << collisions.output;
  EXPECT_TRUE(std::filesystem::exists(out_ / "left+rules_collisions.html"));
  expect_nothing_left(out_);

  for (const auto& [arguments, what] :
       std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"--planner", "nobody"}, "no planner 'nobody'"},
           {{"--episode", "rules_9_9"}, "there is no episode"},
           {{"--collisions"}, "has no collision of hierarchical"},
           {{"--seconds", "-1"}, "give a stretch of time"}}) {
    const CommandResult refused = drive(arguments);
    EXPECT_EQ(refused.status, 1);
    EXPECT_THAT(refused.output, HasSubstr(what));
    EXPECT_EQ(lines_in(refused.output), 1) << refused.output;
  }
}

}  // namespace
}  // namespace corridor::e2e
