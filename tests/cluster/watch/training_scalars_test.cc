// SPDX-License-Identifier: Apache-2.0
#include "cluster/watch/training_scalars.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/run/metrics.h"
#include "proto/run/run_directory.h"
#include "proto/settings/schedule.h"
#include "proto/system/time_account.h"

namespace corridor::cluster {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

// Two actors, 512 steps a round.
MetricsLine line(std::uint64_t round, MetricsValues values, const char* phase = "MoP") {
  return {phase, round, 0, std::move(values)};
}

StepScalars loss(std::int64_t step, double value) { return {step, {{"train/mop/loss", value}}}; }
StepScalars epsilon(std::int64_t step, double value) {
  return {step, {{"train/mop/epsilon", value}}};
}

TEST(TrainingScalars, OfTheLearnerAndTheReplayHaveTagsByPhase) {
  TrainingScalars scalars(Schedule(RunConfig()), 2);
  scalars.on(kLearnerName, 0,
             line(1, {{metric::kTdLoss, 0.5},
                      {time_metric(TimePart::kUpdate), 9.0},
                      {metric::kGreedyScore, 7.0}}));
  scalars.on(kReplayName, 0, line(1, {{metric::kSamplesPerInsert, 32.0}}, "BP"));
  scalars.on(kReplayName, 0, line(2, {{time_metric(TimePart::kInsert), 1.0}}, "BP"));
  EXPECT_THAT(
      scalars.take(),
      ElementsAre(StepScalars{1024, {{"train/mop/loss", 0.5}, {"selection/mop/score", 7.0}}},
                  StepScalars{1024, {{"train/bp/replay_ratio", 32.0}}}));
  EXPECT_THAT(scalars.take(), IsEmpty());
}

TEST(TrainingScalars, CountTheStepsOfBothPhases) {
  const RunConfig config;
  TrainingScalars scalars(Schedule(config), 2);
  const std::uint64_t round = Schedule(config).first_round(Phase::kBp);
  scalars.on(kLearnerName, 0, line(round, {{metric::kTdLoss, 0.5}}, "BP"));
  EXPECT_THAT(scalars.take(), ElementsAre(StepScalars{1'000'448 + 512, {{"train/bp/loss", 0.5}}}));
}

TEST(TrainingScalars, OfTheActorsAreTheirMeansOnceAllOfThemAreThere) {
  TrainingScalars scalars(Schedule(RunConfig()), 2);
  scalars.on(kActorName, 0, line(1, {{metric::kEpisodicReturn, 10.0}, {metric::kEpisodes, 1.0}}));
  scalars.on(kActorName, 0, line(3, {{metric::kEpsilon, 0.25}}));
  EXPECT_THAT(scalars.take(), IsEmpty());
  scalars.on(kActorName, 1, line(1, {{metric::kEpisodicReturn, 20.0}, {metric::kEpisodes, 3.0}}));
  EXPECT_THAT(scalars.take(),
              ElementsAre(StepScalars{1024, {{"train/mop/reward_per_episode", 17.5}}}));
  scalars.on(kActorName, 1, line(3, {{metric::kEpsilon, 0.75}}));
  EXPECT_THAT(scalars.take(), ElementsAre(epsilon(2048, 0.5)));
}

TEST(TrainingScalars, NeverGoBackWhenOneActorIsStartedAgain) {
  TrainingScalars scalars(Schedule(RunConfig()), 2);
  // Actor 1 dies before it tells of round 1, and tells of round 3 twice.
  scalars.on(kActorName, 0, line(1, {{metric::kEpsilon, 1.0}}));
  scalars.on(kActorName, 0, line(3, {{metric::kEpsilon, 0.5}}));
  scalars.on(kActorName, 1, line(3, {{metric::kEpsilon, 0.5}}));
  EXPECT_THAT(scalars.take(), ElementsAre(epsilon(1024, 1.0), epsilon(2048, 0.5)));
  scalars.on(kActorName, 1, line(3, {{metric::kEpsilon, 9.0}}));
  scalars.on(kActorName, 0, line(3, {{metric::kEpsilon, 9.0}}));
  EXPECT_THAT(scalars.take(), IsEmpty());
}

TEST(TrainingScalars, ComeAgainAfterAllWentBack) {
  TrainingScalars scalars(Schedule(RunConfig()), 2);
  for (const std::uint64_t round : {1, 3}) {
    for (const std::size_t actor : {0, 1})
      scalars.on(kActorName, actor, line(round, {{metric::kEpsilon, 1.0}}));
    scalars.on(kLearnerName, 0, line(round, {{metric::kTdLoss, 1.0}}));
  }
  scalars.on(kActorName, 0, line(5, {{metric::kEpsilon, 1.0}}));
  scalars.take();
  scalars.go_back_to(1024);
  for (const std::uint64_t round : {1, 3}) {
    for (const std::size_t actor : {0, 1})
      scalars.on(kActorName, actor, line(round, {{metric::kEpsilon, 2.0}}));
    scalars.on(kLearnerName, 0, line(round, {{metric::kTdLoss, 2.0}}));
  }
  EXPECT_THAT(scalars.take(), ElementsAre(epsilon(2048, 2.0), loss(2048, 2.0)));
}

}  // namespace
}  // namespace corridor::cluster
