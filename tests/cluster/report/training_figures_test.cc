// SPDX-License-Identifier: Apache-2.0
#include "cluster/report/training_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/run/metrics.h"

namespace corridor::cluster {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

MetricsLine line(const char* phase, std::int64_t step, MetricsValues values) {
  return {phase, 0, step, std::move(values)};
}

RunRecord record(std::uint64_t seed, double reward) {
  RunRecord run;
  run.config.run.seed = seed;
  for (DqnSettings& dqn : run.config.dqn) dqn.steps = 25;  // moving average: 1 point
  run.actors = {{line("MoP", 10, {{metric::kRewardPer1000, reward}}),
                 line("MoP", 20, {{metric::kRewardPer1000, 2 * reward}})},
                {}};
  run.learner = {{}};
  return run;
}

std::vector<std::string> names(const std::vector<Figure>& figures) {
  std::vector<std::string> names;
  for (const Figure& figure : figures) names.push_back(figure.name);
  return names;
}

TEST(TrainingFigures, AreThoseForWhichThereAreNumbers) {
  RunRecord run = record(1, 10.0);
  EXPECT_THAT(names(training_figures({{"paper", {run}}})), ElementsAre("mop_training"));
  run.learner = {
      {line("MoP", 10, {{metric::kTdLoss, 1.0}}), line("BP", 10, {{metric::kGreedyScore, 1.0}})}};
  EXPECT_THAT(names(training_figures({{"paper", {run}}})),
              ElementsAre("mop_training", "mop_learning", "bp_selection"));
}

TEST(TrainingFigures, ShowSeveralSeedsAsTheirMeanWithABand) {
  const auto figures = training_figures({{"paper", {record(1, 10.0), record(2, 30.0)}}});
  ASSERT_THAT(figures, SizeIs(1));
  ASSERT_THAT(figures[0].panels, SizeIs(1));
  const PlottedCurve& curve = figures[0].panels[0].curves.at(0);
  EXPECT_THAT(curve.raw,
              ElementsAre(BandPoint{10, 20.0, 10.0, 30.0}, BandPoint{20, 40.0, 20.0, 60.0}));
  EXPECT_THAT(curve.trend,
              ElementsAre(BandPoint{10, 20.0, 10.0, 30.0}, BandPoint{20, 40.0, 20.0, 60.0}));
  EXPECT_THAT(figures[0].caption, HasSubstr("2 training seeds"));
}

TEST(TrainingFigures, HaveTheLevelOfTheRulesThatFitsThePhase) {
  RunRecord run = record(1, 10.0);
  run.actors[1] = {line("BP", 10,
                        {{metric::kRewardPer1000, 1.0},
                         {metric::kCollisionsPer1000, 1.0},
                         {metric::kEpisodicReturn, 1.0},
                         {metric::kEpisodes, 1.0}})};
  EvaluationRecord rules;
  rules.planner = "rules";
  rules.per_episode = {{1000, 500.0, 800.0, 2, 0, 0, 0.0, {}}};
  EvaluationRecord random = rules;
  random.planner = "random+rules";
  random.per_episode[0].mop_reward = 700.0;
  run.evaluations[""] = {rules, random};
  run.evaluations["dense"] = {rules};
  run.evaluations["dense"][0].seed = 7;
  run.evaluations["dense"][0].per_episode[0].bp_reward = 100.0;
  run.worlds_of_training = {""};
  const auto figures = training_figures({{"with", {run}}, {"without", {record(1, 20.0)}}});
  ASSERT_THAT(names(figures), ElementsAre("mop_training", "bp_training"));
  EXPECT_EQ(figures[0].panels.at(0).curves.at(0).level, 700.0);
  EXPECT_EQ(figures[0].panels.at(0).curves.at(1).level, std::nullopt);
  ASSERT_THAT(figures[1].panels, SizeIs(3));
  EXPECT_EQ(figures[1].panels[0].curves[0].level, 500.0);
  EXPECT_EQ(figures[1].panels[1].curves[0].level, 2.0);
  EXPECT_EQ(figures[1].panels[2].curves[0].level, 500.0);
  EXPECT_THAT(figures[1].panels[0].curves.at(1).trend, IsEmpty());
}

}  // namespace
}  // namespace corridor::cluster
