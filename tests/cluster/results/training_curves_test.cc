// SPDX-License-Identifier: Apache-2.0
#include "cluster/results/training_curves.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/base/failure.h"
#include "proto/run/metrics.h"

namespace corridor::cluster {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;
using testing::ThrowsMessage;

MetricsLine line(std::int64_t step, MetricsValues values, const char* phase = "MoP") {
  return {phase, static_cast<std::uint64_t>(step / 10), step, std::move(values)};
}

TEST(MetricsFile, LeavesOutWhatADeadProcessDidNotFinish) {
  const auto lines = parse_metrics(
      "{\"phase\":\"MoP\",\"round\":0,\"step\":10,\"x\":1}\n"
      "{\"phase\":\"MoP\",\"round\":1,\"st\n"
      "{\"phase\":\"MoP\",\"round\":1,\"step\":20,\"x\":2}\n"
      "{\"phase\":\"MoP\",\"rou",
      "a.jsonl");
  ASSERT_THAT(lines, SizeIs(2));
  EXPECT_EQ(lines[1].step, 20);
}

TEST(MetricsFile, NamesADamagedLine) {
  EXPECT_THAT(
      [] {
        parse_metrics("{\"phase\":\"MoP\",\"round\":0,\"step\":10}\n{\"phase\":7}\n", "a.jsonl");
      },
      ThrowsMessage<Failure>(HasSubstr("a.jsonl:2 is no line of metrics")));
}

TEST(Curve, IsOneNumberOfOnePhaseInTheOrderOfSteps) {
  const ProcessMetrics lines = {line(20, {{"x", 2.0}}), line(10, {{"x", 1.0}, {"y", 9.0}}),
                                line(10, {{"x", 7.0}}, "BP"), line(30, {{"y", 5.0}})};
  EXPECT_THAT(curve_of({lines}, Phase::kMop, "x"),
              ElementsAre(CurvePoint{10, 1.0}, CurvePoint{20, 2.0}));
}

TEST(Curve, IsTheWeightedMeanOfItsProcesses) {
  const ProcessMetrics one = {line(10, {{"x", 1.0}, {"n", 1.0}}), line(20, {{"x", 5.0}})};
  const ProcessMetrics other = {line(10, {{"x", 4.0}, {"n", 3.0}}), line(20, {{"x", 7.0}})};
  EXPECT_THAT(curve_of({one, other}, Phase::kMop, "x"),
              ElementsAre(CurvePoint{10, 2.5, 2.0}, CurvePoint{20, 6.0, 2.0}));
  EXPECT_THAT(curve_of({one, other}, Phase::kMop, "x", "n"), ElementsAre(CurvePoint{10, 3.25, 4.0}))
      << "what has no weight is a mean of nothing";
}

TEST(Curve, HasWhatWasWrittenLastOfAStepDrivenAgain) {
  const ProcessMetrics lines = {line(10, {{"x", 1.0}}), line(20, {{"x", 2.0}, {"y", 2.0}}),
                                line(20, {{"x", 3.0}})};
  EXPECT_THAT(curve_of({lines}, Phase::kMop, "x"),
              ElementsAre(CurvePoint{10, 1.0}, CurvePoint{20, 3.0}));
  EXPECT_TRUE(curve_of({lines}, Phase::kMop, "y").empty());
}

TEST(MovingAverage, IsTheWeightedMeanAroundEachPoint) {
  const Curve curve = {{10, 1.0, 1.0}, {20, 4.0, 2.0}, {30, 10.0, 1.0}, {90, 5.0, 1.0}};
  const Curve average = moving_average(curve, 20);
  EXPECT_THAT(average, ElementsAre(CurvePoint{10, 3.0, 3.0}, CurvePoint{20, 4.75, 4.0},
                                   CurvePoint{30, 6.0, 3.0}, CurvePoint{90, 5.0, 1.0}));
  EXPECT_EQ(moving_average(curve, 0), curve);
  EXPECT_TRUE(moving_average({}, 20).empty());
}

TEST(Band, RunsFromTheLowestToTheHighestWhereAllCurvesAre) {
  const Curve a = {{10, 1.0}, {20, 2.0}, {30, 9.0}}, b = {{10, 5.0}, {20, -2.0}};
  EXPECT_THAT(band_of({a, b}),
              ElementsAre(BandPoint{10, 3.0, 1.0, 5.0}, BandPoint{20, 0.0, -2.0, 2.0}));
  EXPECT_THAT(band_of({b}),
              ElementsAre(BandPoint{10, 5.0, 5.0, 5.0}, BandPoint{20, -2.0, -2.0, -2.0}));
}

EvaluationRecord result(const char* planner, std::uint64_t seed,
                        std::vector<EpisodeRecord> episodes) {
  EvaluationRecord result;
  result.planner = planner;
  result.seed = seed;
  result.per_episode = std::move(episodes);
  return result;
}

TEST(Level, IsInTheUnitsOfTheCurvesOfItsPhase) {
  const std::vector<EvaluationRecord> results = {
      result("rules", 1, {{100, 60.0, 80.0, 0, 0, 0, 0.0, {}}, {50, 20.0, 10.0, 1, 0, 0, 0.0, {}}}),
      result("sumo", 1, {{100, 1e6, 1e6, 0, 0, 0, 0.0, {}}}),
      result("rules", 1, {{100, 1e6, 1e6, 0, 0, 0, 0.0, {}}}),
      // Cut off when the steps were used up.
      result("rules", 2, {{50, 20.0, 30.0, 0, 0, 0, 0.0, {}}})};
  const auto bp = level_of(results, "rules", Phase::kBp, 100);
  ASSERT_TRUE(bp);
  EXPECT_DOUBLE_EQ(bp->reward_per_1000, 500.0);
  EXPECT_DOUBLE_EQ(bp->collisions_per_1000, 5.0);
  EXPECT_DOUBLE_EQ(bp->reward_per_episode, 40.0);
  const auto mop = level_of(results, "rules", Phase::kMop, 100);
  EXPECT_DOUBLE_EQ(mop->reward_per_1000, 600.0);
  EXPECT_DOUBLE_EQ(mop->reward_per_episode, 45.0);
  EXPECT_FALSE(level_of(results, "random+rules", Phase::kMop, 100));
}

}  // namespace
}  // namespace corridor::cluster
