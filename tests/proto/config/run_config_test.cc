// SPDX-License-Identifier: Apache-2.0
#include "proto/config/run_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "proto/config/config_values.h"
#include "tests/support/failure_of.h"
#include "tests/support/temporary_directory.h"

namespace corridor {
namespace {

using testing::AllOf;
using testing::HasSubstr;

RunConfig parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return parse_run_config(text, "test.toml", overrides);
}

std::string fault_in(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return failure_of([&] { parse(text, overrides); });
}

TEST(RunConfig, AnEmptyScenarioIsTheDefaults) { EXPECT_EQ(to_toml(parse("")), to_toml({})); }

TEST(RunConfig, TheBpHasDefaultsOfItsOwn) {
  const RunConfig config = parse("[bp]\nn_step = 7");
  EXPECT_EQ(config.phase(Phase::kMop).gamma, DqnSettings{}.gamma);
  EXPECT_EQ(config.phase(Phase::kBp).gamma, bp_defaults().gamma);
  EXPECT_NE(DqnSettings{}.gamma, bp_defaults().gamma);
  EXPECT_EQ(config.phase(Phase::kBp).n_step, 7);
}

TEST(RunConfig, KeysOfEveryTypeAreRead) {
  const RunConfig config = parse(R"(
    [road]
    lanes = 2
    speed_limit_mps = 10       # a whole number is a number
    [bp_reward]
    thresholds_mps = [9, 10.5]
    [mop]
    hidden = [32]
    dueling = true
    steps = 5_000_000_000
    [evaluation]
    seeds = [9223372036854775806, 0]
    [run]
    device = "cuda"
    host = "node-1.example.org"
  )");
  EXPECT_EQ(config.road.lanes, 2);
  EXPECT_EQ(config.road.speed_limit_mps, 10.0);
  EXPECT_EQ(config.bp_reward.thresholds_mps, (std::vector<double>{9.0, 10.5}));
  EXPECT_EQ(config.phase(Phase::kMop).hidden, std::vector<int>{32});
  EXPECT_TRUE(config.phase(Phase::kMop).dueling);
  EXPECT_FALSE(config.phase(Phase::kBp).dueling);
  EXPECT_EQ(config.phase(Phase::kMop).steps, 5'000'000'000);
  EXPECT_EQ(config.evaluation.seeds, (std::vector<std::uint64_t>{9223372036854775806ULL, 0}));
  EXPECT_EQ(config.run.device, Device::kCuda);
  EXPECT_EQ(config.run.host, "node-1.example.org");
}

TEST(RunConfig, AWholeNumberMayBeWrittenWithAnExponent) {
  EXPECT_EQ(parse("[mop]\nsteps = 2e6\n").phase(Phase::kMop).steps, 2'000'000);
  EXPECT_EQ(parse("[run]\nactors = 3.0\n").run.actors, 3);
}

TEST(RunConfig, WhatIsWrittenIsReadEqual) {
  const RunConfig config = parse(
      "", {"traffic.blind_rate_per_s=0.1", "mop.learning_rate=3.3e-4", "bp.adam_epsilon=1e-12",
           "road.length_m=123456.789", "planner.speed_changes_mps=[-0.1, 0, 0.30000000000000004]",
           "run.seed=9223372036854775806", "road.speed_limit_mps=20"});
  const std::string text = to_toml(config);
  const RunConfig again = parse(text);
  EXPECT_EQ(to_toml(again), text);
  EXPECT_EQ(again.planner.speed_changes_mps, config.planner.speed_changes_mps);
  EXPECT_EQ(again.traffic.blind_rate_per_s, 0.1);
  EXPECT_EQ(again.phase(Phase::kBp).adam_epsilon, 1e-12);
  EXPECT_EQ(again.run.seed, config.run.seed);
}

TEST(RunConfig, WhatIsWrittenIsCommented) {
  EXPECT_THAT(to_toml({}),
              AllOf(HasSubstr("# One straight edge"), HasSubstr("[road]\nlanes = 3"),
                    HasSubstr("speed_limit_mps = 13.89\n"), HasSubstr("length_m = 20000.0"),
                    HasSubstr("# SUMO's lcKeepRight")));
}

TEST(RunConfig, WrongValuesAreNamedWithFileLineKeyValueAndRange) {
  EXPECT_EQ(fault_in("[run]\n\nactors = 0"),
            "test.toml:3: run.actors = 0: must be a whole number from 1 to 1024");
  EXPECT_EQ(fault_in("", {"mop.gamma=1.5"}),
            "override: mop.gamma = 1.5: must be a number from 0 to 0.99999");
}

TEST(RunConfig, WrongValuesAreShownOnOneLineAsEveryVersionOfTheLibraryReadsThem) {
  const auto shown = [](const std::string& value) {
    const std::string fault = fault_in("[run]\nactors = " + value);
    const std::string head = "test.toml:2: run.actors = ";
    EXPECT_TRUE(fault.starts_with(head)) << fault;
    return fault.substr(head.size(), fault.rfind(": must be ") - head.size());
  };
  EXPECT_EQ(shown("0x1_000  # of them"), "4096");
  EXPECT_EQ(shown("1.50"), "1.5");
  EXPECT_EQ(shown("'lit\"eral'"), R"("lit\"eral")");
  EXPECT_EQ(shown("\"\"\"\ntwo\nlines\"\"\""), R"("two\nlines")");
  EXPECT_EQ(shown("[1,\n 2.0, [], [true]]"), "[1, 2.0, [], [true]]");
  EXPECT_EQ(shown("{x = 1, a = ['b']}"), R"({a = ["b"], x = 1})");
  EXPECT_EQ(shown("1979-05-27"), "1979-05-27");
  EXPECT_EQ(shown("[" + std::string(100, ' ') + "1]"), "[1]");
  EXPECT_EQ(shown('"' + std::string(100, 'x') + '"'), '"' + std::string(79, 'x') + " ...");
}

struct Bad {
  const char* override;
  const char* why;
};

class BadValue : public testing::TestWithParam<Bad> {};

TEST_P(BadValue, IsRefused) {
  const std::string text = GetParam().override;
  const std::string key = text.substr(0, text.find('='));
  EXPECT_THAT(fault_in("", {text}), AllOf(HasSubstr(key), HasSubstr(GetParam().why)));
}

INSTANTIATE_TEST_SUITE_P(
    RunConfig, BadValue,
    testing::Values(
        Bad{"run.actors=2.5", "whole number"}, Bad{"mop.steps=1e300", "whole number"},
        Bad{"mop.steps=inf", "whole number"}, Bad{"run.actors=true", "whole number"},
        Bad{"run.actors=\"2\"", "whole number"}, Bad{"run.actors=[2]", "whole number"},
        Bad{"run.actors=1025", "1 to 1024"}, Bad{"run.seed=-1", "0 to 9223372036854775806"},
        Bad{"road.lanes=4294967299", "1 to 8"},  // 3 in 32 bits
        Bad{"mop.steps=0", "whole number"}, Bad{"mop.gamma=nan", "= nan"},
        Bad{"mop.huber_delta=inf", "= inf"}, Bad{"mop.gamma=-inf", "number"},
        Bad{"mop.gamma=true", "number"}, Bad{"mop.gamma=\"0.9\"", "number"},
        Bad{"mop.gamma=high", "number"}, Bad{"mop.gamma=1979-05-27", "number"},
        Bad{"mop.double_q=1", "true or false"}, Bad{"mop.double_q=yes", "true or false"},
        Bad{"mop.hidden=64", "a list of numbers"}, Bad{"mop.hidden=[]", "1 to 8 numbers"},
        Bad{"mop.hidden=[64, 0]", "each a whole number from 1 to 4096"},
        Bad{"mop.hidden=[64, 64.5]", "each a whole number"},
        Bad{"mop.hidden=[1,2,3,4,5,6,7,8,9]", "1 to 8 numbers"},
        Bad{"planner.speed_changes_mps=[0, nan]", "each a number"},
        Bad{"evaluation.seeds=[]", "1 to 1000 numbers"},
        Bad{"run.device=gpu", "must be one of cpu, cuda"},
        Bad{"run.device=1", "must be one of cpu, cuda"},
        Bad{"run.transport=udp", "must be one of ipc, tcp"},
        Bad{"run.host=\"\"", "a name or an address"},
        Bad{"run.host=\"a b\"", "a name or an address"}, Bad{"run.replay_port=65536", "1 to 65535"},
        Bad{"run.peer_timeout_s=0", "number from"},
        Bad{"run={actors=2}", "must be table.key=value"},
        Bad{"run.actors", "must be table.key=value"}, Bad{"actors=2", "must be table.key=value"},
        Bad{"a.b.c=2", "must be table.key=value"}, Bad{"run.actors=", "not valid TOML"},
        Bad{"run.actors=[1", "not valid TOML"},
        Bad{"run.seed=9223372036854775807", "0 to 9223372036854775806"},
        Bad{"run.seed=99999999999999999999", "0 to 9223372036854775806"},
        Bad{"run.actors=1\n[road]\nlanes=2", "must be table.key=value"}));

TEST(RunConfig, ALongListOfSpeedChangesWouldNotFitAByte) {
  std::string list;
  for (int i = 0; i < 28; ++i) list += fmt::format("{}.5,", i - 14);
  EXPECT_EQ(
      parse("", {"planner.speed_changes_mps=[" + list + "]"}).planner.speed_changes_mps.size(),
      28U);
  EXPECT_THAT(fault_in("", {"planner.speed_changes_mps=[" + list + "15.5]"}),
              HasSubstr("a list of 1 to 28 numbers"));
}

TEST(RunConfig, KeysThatThereAreNoMoreMayStillSayWhatIsAlwaysSo) {
  EXPECT_EQ(to_toml(parse("[run]\ndelay_ms_max = 0.0")), to_toml({}));
  EXPECT_EQ(fault_in("[run]\ndelay_ms_max = 40.0"),
            "test.toml:2: run.delay_ms_max = 40.0: there is no such key any more: tests set "
            "CORRIDOR_TEST_DELAY_MS");
}

TEST(RunConfig, AWorldIsRefusedByTheNameThatItHadAndNamedAsItIsCalledNow) {
  EXPECT_EQ(fault_in("[dynamics]\nworld = \"webots\""),
            "test.toml:2: dynamics.world = \"webots\": it is called \"rigid\" now");
}

TEST(RunConfig, OverridesChangeAConfigurationAndItIsCheckedAgain) {
  const RunConfig config = with_overrides(parse("[road]\nlanes = 3"), "x", {"run.actors=7"});
  EXPECT_EQ(config.road.lanes, 3);
  EXPECT_EQ(config.run.actors, 7);
  EXPECT_THAT(failure_of([&] { with_overrides(config, "x", {"road.lanes=4"}); }),
              HasSubstr("x: bp_reward.thresholds_mps has 3 values"));
}

TEST(RunConfig, UnknownKeysAreErrorsAndTheNearestIsSuggested) {
  EXPECT_EQ(fault_in("[traffic]\nvehicle_max = 3"),
            "test.toml:2: unknown key traffic.vehicle_max: did you mean vehicles_max?");
  EXPECT_THAT(fault_in("[evaluation]\nhorizon = 3"), HasSubstr("known are [\"steps\", \"seeds\"]"));
  EXPECT_EQ(fault_in("[trafic]\nwindow_m = 3"),
            "test.toml:1: unknown table [trafic]: did you mean traffic?");
  EXPECT_THAT(fault_in("lanes = 3"), HasSubstr("test.toml:1: unknown table [lanes]"));
  EXPECT_THAT(fault_in("", {"run.actor=3"}),
              HasSubstr("override: unknown key run.actor: did you mean actors?"));
}

TEST(RunConfig, ATableMustBeATable) {
  EXPECT_EQ(fault_in("road = 3"), "test.toml:1: road is no table: write [road] and its keys below");
}

TEST(RunConfig, WhatIsNotTomlIsOneLineWithItsPlace) {
  for (const char* text :
       {"[road\nlanes = 3", "[road]\nlanes = ", "[road]\nlanes 3", "[road]\nlanes = 3\nlanes = 3",
        "\x01\xff\xfe", "[run]\nhost = \"unclosed"}) {
    const std::string failure = fault_in(text);
    EXPECT_THAT(failure, AllOf(HasSubstr("test.toml"), HasSubstr("not valid TOML"))) << text;
    EXPECT_EQ(failure.find('\n'), std::string::npos) << failure;
  }
}

TEST(RunConfig, OverridesApplyInOrderAndTakeBareWords) {
  const RunConfig config =
      parse("[run]\nactors = 5", {"run.actors=6", "run.actors=7", "run.transport=tcp",
                                  "run.host=10.0.0.1", "mop.hidden=[8, 8]", "run.device=\"cuda\""});
  EXPECT_EQ(config.run.actors, 7);
  EXPECT_EQ(config.run.transport, Transport::kTcp);
  EXPECT_EQ(config.run.host, "10.0.0.1");
  EXPECT_EQ(config.run.device, Device::kCuda);
  EXPECT_EQ(config.phase(Phase::kMop).hidden, (std::vector<int>{8, 8}));
}

class ScenarioFiles : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) {
    const auto file = directory_.path() / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
    return file;
  }
  testing_support::TemporaryDirectory directory_;
};

TEST_F(ScenarioFiles, SayOnlyWhatDiffersFromTheirBase) {
  write("base.toml", "[run]\nactors = 4\nseed = 9\n[road]\nlength_m = 30000");
  write("deep/middle.toml", "base = \"../base.toml\"\n[run]\nactors = 5");
  const auto file = write("top.toml", "base = \"deep/middle.toml\"\n[traffic]\nkeep_right = 0");
  const RunConfig config = load_run_config(file, {"run.seed=11"});
  EXPECT_EQ(config.run.actors, 5);
  EXPECT_EQ(config.run.seed, 11U);
  EXPECT_EQ(config.road.length_m, 30000.0);
  EXPECT_EQ(config.traffic.keep_right, 0.0);
}

TEST_F(ScenarioFiles, AFaultInTheBaseNamesTheBase) {
  write("base.toml", "[run]\nactors = 0");
  const auto file = write("top.toml", "base = \"base.toml\"");
  EXPECT_THAT(failure_of([&] { load_run_config(file); }), HasSubstr("base.toml:2: run.actors = 0"));
}

TEST_F(ScenarioFiles, ABaseThatLeadsBackIsRefused) {
  write("one.toml", "base = \"two.toml\"");
  const auto file = write("two.toml", "base = \"./one.toml\"");
  EXPECT_THAT(failure_of([&] { load_run_config(file); }), HasSubstr("base leads back"));
  const auto self = write("self.toml", "base = \"self.toml\"");
  EXPECT_THAT(failure_of([&] { load_run_config(self); }), HasSubstr("base leads back"));
}

TEST_F(ScenarioFiles, MissingOnesAreNamed) {
  EXPECT_THAT(failure_of([&] { load_run_config(directory_.path() / "none.toml"); }),
              AllOf(HasSubstr("none.toml"), HasSubstr("No such file")));
  const auto file = write("top.toml", "base = \"none.toml\"");
  EXPECT_THAT(failure_of([&] { load_run_config(file); }), HasSubstr("none.toml"));
  const auto number = write("number.toml", "base = 3");
  EXPECT_THAT(failure_of([&] { load_run_config(number); }), HasSubstr("a file's name in quotes"));
}

TEST(RunConfig, TextHasNoBase) {
  EXPECT_THAT(fault_in("base = \"x.toml\""), HasSubstr("base is for scenario files"));
}

}  // namespace
}  // namespace corridor
