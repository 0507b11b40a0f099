// SPDX-License-Identifier: Apache-2.0
#include "proto/run/metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <sstream>

#include "proto/base/json.h"
#include "proto/run/run_directory.h"
#include "proto/system/files.h"
#include "tests/support/failure_of.h"
#include "tests/support/temporary_directory.h"

namespace corridor {
namespace {

class Metrics : public testing::Test {
 protected:
  std::vector<OrderedJson> lines() const {
    std::istringstream in(read_file(file_));
    std::vector<OrderedJson> result;
    for (std::string line; std::getline(in, line);) {
      result.push_back(OrderedJson::parse(line));
    }
    return result;
  }
  testing_support::TemporaryDirectory directory_;
  std::filesystem::path file_ = directory_.path() / "learner.jsonl";
};

TEST_F(Metrics, AreOneObjectALineInTheOrderGiven) {
  MetricsWriter writer(file_);
  writer.write("MoP", 7, 3584, {{metric::kTdLoss, 0.1}, {metric::kStepsPerS, 1e9}});
  ASSERT_EQ(lines().size(), 1U);  // flushed already
  const auto line = lines()[0];
  std::vector<std::string> names;
  for (const auto& [name, value] : line.items()) names.push_back(name);
  EXPECT_THAT(names, testing::ElementsAre("phase", "round", "step", "time_s", "memory_mb",
                                          "losses/td_loss", "charts/SPS"));
  EXPECT_EQ(line["phase"], "MoP");
  EXPECT_EQ(line["round"], 7);
  EXPECT_EQ(line["step"], 3584);
  EXPECT_GE(line["time_s"], 0.0);
  EXPECT_GT(line["memory_mb"], 0.5);
  EXPECT_EQ(line["losses/td_loss"], 0.1);
}

TEST_F(Metrics, AreAppendedByTheNextProcess) {
  MetricsWriter(file_).write("MoP", 1, 1, {});
  MetricsWriter(file_).write("MoP", 2, 2, {});
  EXPECT_EQ(lines().size(), 2U);
}

TEST_F(Metrics, ALineThatAProcessDiedInIsNotContinued) {
  write_file(file_, "{\"phase\":\"MoP\"}\n{\"pha");
  MetricsWriter(file_).write("BP", 2, 2, {});
  const std::string text = read_file(file_);
  EXPECT_THAT(text, testing::StartsWith("{\"phase\":\"MoP\"}\n{\"pha\n{\"phase\":\"BP\""));
}

TEST_F(Metrics, WhatIsNoNumberIsNull) {
  MetricsWriter(file_).write("MoP", 1, 1, {{"x", std::numeric_limits<double>::quiet_NaN()}});
  EXPECT_TRUE(lines()[0]["x"].is_null());
}

TEST_F(Metrics, AFileThatCannotBeOpenedOrWrittenIsNamed) {
  EXPECT_THAT(failure_of([&] { MetricsWriter writer(directory_.path()); }),
              testing::HasSubstr(directory_.path().string()));
  MetricsWriter full("/dev/full");
  EXPECT_THAT(failure_of([&] { full.write("MoP", 1, 1, {}); }), testing::HasSubstr("/dev/full"));
}

TEST_F(Metrics, TheLastWholeLineIsFoundBehindATornOne) {
  EXPECT_FALSE(last_metrics_line(file_));
  MetricsWriter writer(file_);
  for (std::uint64_t round = 0; round < 2000; ++round) writer.write("MoP", round, 1, {});
  std::ofstream(file_, std::ios::app) << "{\"phase\":\"MoP\",\"rou";
  EXPECT_EQ(last_metrics_line(file_)->round, 1999u);
}

TEST(MetricsLine, IsReadWithItsPlaceAndAllItsNumbers) {
  const auto line = parse_metrics_line(
      R"({"phase":"BP","round":7,"step":3584,"time_s":1.25,"charts/SPS":7000,"eval/x":null})");
  ASSERT_TRUE(line);
  EXPECT_EQ(line->phase, "BP");
  EXPECT_EQ(line->round, 7u);
  EXPECT_EQ(line->step, 3584);
  EXPECT_EQ(line->values,
            (std::map<std::string, double, std::less<>>{{"time_s", 1.25}, {"charts/SPS", 7000.0}}));
}

TEST(MetricsLine, IsNothingWhenTornOrForeign) {
  for (const char* text :
       {"", "{", R"({"phase":"BP","round":7,"step":35)", "[1,2]", "null", "7",
        R"({"phase":"BP","round":-1,"step":0})", R"({"phase":3,"round":1,"step":0})",
        R"({"round":1,"step":0})", R"({"phase":"BP","round":1.5,"step":0})", "\xff\xfe"}) {
    EXPECT_FALSE(parse_metrics_line(text)) << text;
  }
}

}  // namespace
}  // namespace corridor
