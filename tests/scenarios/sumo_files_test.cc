// SPDX-License-Identifier: Apache-2.0
#include "scenarios/sumo_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <optional>

#include "proto/base/failure.h"
#include "proto/config/config_values.h"
#include "proto/config/run_config.h"
#include "proto/run/run_directory.h"
#include "proto/settings/sumo_names.h"
#include "proto/system/files.h"
#include "tests/support/temporary_directory.h"

namespace corridor::scenarios {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class SumoFiles : public testing::Test {
 protected:
  SumoFiles() {
    for (const char* variable : {"SUMO_HOME", "PATH"}) {
      const char* value = std::getenv(variable);
      saved_.emplace_back(variable, value ? std::optional<std::string>(value) : std::nullopt);
    }
  }
  ~SumoFiles() override {
    for (const auto& [variable, value] : saved_) {
      value ? setenv(variable.c_str(), value->c_str(), 1) : unsetenv(variable.c_str());
    }
  }

  // A SUMO whose netconvert is this shell script.
  void install_netconvert(const std::string& script) {
    const fs::path program = directory_ / "sumo" / "bin" / "netconvert";
    fs::create_directories(program.parent_path());
    std::ofstream(program) << "#!/bin/sh\n" << script << "\n";
    fs::permissions(program, fs::perms::owner_all);
    setenv("SUMO_HOME", (directory_ / "sumo").c_str(), 1);
  }

  std::string failure_of(const RunConfig& config, std::chrono::milliseconds deadline) const {
    try {
      write_sumo_files(config, directory_ / "run", deadline);
    } catch (const Failure& failure) {
      return failure.what();
    }
    return "no failure";
  }

  testing_support::TemporaryDirectory temporary_;
  fs::path directory_ = temporary_.path();
  std::vector<std::pair<std::string, std::optional<std::string>>> saved_;
};

constexpr std::chrono::milliseconds kLong = std::chrono::seconds(60);

TEST_F(SumoFiles, GiveANetworkWithTheLanesSet) {
  RunConfig config;
  config.road.lanes = 4;
  config.road.lane_width_m = 3.25;
  config.road.length_m = 1234.5;
  config.road.speed_limit_mps = 20.5;
  write_sumo_files(config, directory_ / "a" / "b");
  const std::string network = read_file(directory_ / "a" / "b" / kSumoNetworkFile);
  EXPECT_THAT(network, HasSubstr("<edge id=\"road\""));
  for (const char* lane : {"road_0", "road_1", "road_2", "road_3"}) {
    EXPECT_THAT(network, HasSubstr(fmt::format("<lane id=\"{}\"", lane)));
  }
  EXPECT_THAT(network, Not(HasSubstr("road_4")));
  EXPECT_THAT(network, HasSubstr("length=\"1234.5000\""));
  EXPECT_THAT(network, HasSubstr("speed=\"20.5000\""));
  EXPECT_THAT(network, HasSubstr("0.0000,-1.6250"));  // the left lane's centre, not rounded
}

TEST_F(SumoFiles, DescribeEveryKindWithEveryAlignment) {
  RunConfig config;
  TrafficSettings& traffic = config.traffic;
  traffic.speed_factor_mean = 0.7;
  traffic.speed_factor_deviation = 0.1;
  traffic.speed_factor_min = 0.5;
  traffic.speed_factor_max = 1.1;
  traffic.keep_right = 0.0;
  traffic.object_length_m = 2.5;
  traffic.object_width_m = 0.5;
  config.ego.length_m = 4.5;
  write_sumo_files(config, directory_);
  const std::string xml = read_file(directory_ / kSumoRoutesFile);
  for (const char* kind : kVehicleKinds) {
    for (const char* alignment : kAlignments) {
      EXPECT_THAT(xml, HasSubstr(fmt::format("<vType id=\"{}_{}\"", kind, alignment)));
    }
  }
  EXPECT_THAT(xml, HasSubstr("speedFactor=\"normc(0.7,0.1,0.5,1.1)\""));
  EXPECT_THAT(xml, HasSubstr("lcKeepRight=\"0\""));
  EXPECT_THAT(xml, HasSubstr("<vType id=\"ego\" speedFactor=\"1\" speedDev=\"0\" length=\"4.5\""));
  EXPECT_THAT(xml, HasSubstr("<vType id=\"object\" length=\"2.5\" width=\"0.5\""));
  EXPECT_THAT(xml, HasSubstr("<route id=\"road\" edges=\"road\"/>"));
}

TEST_F(SumoFiles, OpenInSumo) {
  RunConfig config;
  write_sumo_files(config, directory_);
  // sumo-gui reads the same configuration, but needs a display.
  const std::string command = "sumo -c " + (directory_ / "road.sumocfg").string() +
                              " --end 3 --no-step-log >/dev/null 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST_F(SumoFiles, TellWhatNetconvertRefuses) {
  RunConfig config;
  config.road.lanes = 0;
  EXPECT_THAT(
      failure_of(config, kLong),
      AllOf(HasSubstr("road.edg.xml"), HasSubstr("needs at least one lane"), Not(HasSubstr("\n"))));
}

TEST_F(SumoFiles, TellTheFirstErrorLineAndNotTheWarnings) {
  install_netconvert(
      "echo 'Warning: odd'; echo 'Error: the worst' >&2; echo 'Error: more'; exit 1");
  EXPECT_THAT(failure_of({}, kLong),
              AllOf(HasSubstr("exit status 1"), HasSubstr("Error: the worst"),
                    Not(HasSubstr("odd")), Not(HasSubstr("more"))));
}

TEST_F(SumoFiles, FailWhenNetconvertSucceedsWithoutANetwork) {
  install_netconvert("exit 0");
  EXPECT_THAT(failure_of({}, kLong), HasSubstr("road.edg.xml"));
}

TEST_F(SumoFiles, DoNotWaitForeverForNetconvert) {
  install_netconvert("exec sleep 1000");
  EXPECT_THAT(failure_of({}, std::chrono::milliseconds(0)), HasSubstr("0 ms"));
}

TEST_F(SumoFiles, TellHowToInstallAMissingSumo) {
  unsetenv("SUMO_HOME");
  setenv("PATH", directory_.c_str(), 1);
  EXPECT_THAT(failure_of({}, kLong), AllOf(HasSubstr("netconvert"), HasSubstr("install SUMO")));
}

TEST_F(SumoFiles, TellADirectoryThatCannotBeMade) {
  std::ofstream(directory_ / "run") << "a file";
  EXPECT_THAT(failure_of({}, kLong), HasSubstr("run"));
}

const fs::path kScenarios = fs::path(CORRIDOR_SOURCE_DIR) / "scenarios";

// The text of the tables before [mop]: the world, the planners, the rewards, the rules.
std::string driving_part(const RunConfig& config) {
  const std::string text = to_toml(config);
  return text.substr(0, text.find("[mop]"));
}

TEST(Scenarios, ThePapersRoadTrafficAndPlannersAreTheDefaults) {
  RunConfig paper = load_run_config(kScenarios / "paper.toml");
  paper.training_traffic = {};
  EXPECT_EQ(driving_part(paper), driving_part(RunConfig{}));
}

TEST(Scenarios, ThePapersBudgetsAreThePapers) {
  const RunConfig paper = load_run_config(kScenarios / "paper.toml");
  EXPECT_EQ(paper.phase(Phase::kMop).steps, 1'000'000);
  EXPECT_EQ(paper.phase(Phase::kBp).steps, 400'000);
  EXPECT_EQ(paper.evaluation.steps, 40'000);
  EXPECT_EQ(paper.simulation.episode_steps, 1000);
}

// Anything else would make results on them no comparison.
TEST(Scenarios, TheOtherTrafficDiffersInTrafficOnly) {
  const RunConfig paper = load_run_config(kScenarios / "paper.toml");
  for (const char* name :
       {"calm.toml", "risky.toml", "dense.toml", "sparse.toml", "partial_block.toml"}) {
    RunConfig other = load_run_config(kScenarios / name);
    EXPECT_NE(to_toml(other), to_toml(paper)) << name;
    other.traffic = paper.traffic;
    EXPECT_EQ(to_toml(other), to_toml(paper)) << name;
  }
}

TEST(Scenarios, AnEpisodeOfHalfSecondStepsLastsAsLong) {
  const RunConfig paper = load_run_config(kScenarios / "paper.toml");
  RunConfig half = load_run_config(kScenarios / "paper_half_second.toml");
  EXPECT_EQ(half.simulation.step_s, paper.simulation.step_s / 2);
  EXPECT_EQ(half.simulation.episode_steps, paper.simulation.episode_steps * 2);
  half.simulation = paper.simulation;
  EXPECT_EQ(to_toml(half), to_toml(paper));
}

TEST(Scenarios, TrainingOnDrivesWhereItBegan) {
  const RunConfig paper = load_run_config(kScenarios / "paper.toml");
  const RunConfig joint = load_run_config(kScenarios / "joint.toml");
  EXPECT_EQ(driving_part(joint), driving_part(paper));
  for (const Phase phase : {Phase::kMop, Phase::kBp}) {
    EXPECT_EQ(joint.parameters(phase), paper.parameters(phase));
  }
  EXPECT_EQ(joint.schedule.mop_commands, MopCommands::kLearned);
}

TEST(Scenarios, TheSmokeTestDiffersInBudgetsOnly) {
  const RunConfig paper = load_run_config(kScenarios / "paper.toml");
  RunConfig smoke = load_run_config(kScenarios / "smoke.toml");
  EXPECT_LT(smoke.phase(Phase::kMop).steps, 100'000);
  EXPECT_LT(smoke.phase(Phase::kBp).steps, 100'000);
  smoke.schedule = paper.schedule;
  smoke.evaluation = paper.evaluation;
  for (std::size_t phase = 0; phase < kNetworks.size(); ++phase) {
    smoke.dqn[phase].steps = paper.dqn[phase].steps;
    smoke.dqn[phase].epsilon_steps = paper.dqn[phase].epsilon_steps;
  }
  EXPECT_EQ(to_toml(smoke), to_toml(paper));
}

}  // namespace
}  // namespace corridor::scenarios
