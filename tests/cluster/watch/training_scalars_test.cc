#include "cluster/watch/training_scalars.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/run/metrics.h"
#include "proto/settings/schedule.h"

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
  TrainingScalars scalars{RunConfig()};
  scalars.on_learner(line(1, {{"losses/td_loss", 0.5}, {"time/update", 9.0}, {"eval/score", 7.0}}));
  scalars.on_replay(line(1, {{"replay/samples_per_insert", 32.0}}, "BP"));
  scalars.on_replay(line(2, {{"time/insert", 1.0}}, "BP"));
  EXPECT_THAT(
      scalars.take(),
      ElementsAre(StepScalars{1024, {{"train/mop/loss", 0.5}, {"selection/mop/score", 7.0}}},
                  StepScalars{1024, {{"train/bp/replay_ratio", 32.0}}}));
  EXPECT_THAT(scalars.take(), IsEmpty());
}

TEST(TrainingScalars, CountTheStepsOfBothPhases) {
  const RunConfig config;
  TrainingScalars scalars(config);
  const std::uint64_t round = Schedule(config).first_round(Phase::kBp);
  scalars.on_learner(line(round, {{"losses/td_loss", 0.5}}, "BP"));
  EXPECT_THAT(scalars.take(), ElementsAre(StepScalars{1'000'448 + 512, {{"train/bp/loss", 0.5}}}));
}

TEST(TrainingScalars, OfTheActorsAreTheirMeansOnceAllOfThemAreThere) {
  TrainingScalars scalars{RunConfig()};
  scalars.on_actor(0, line(1, {{"charts/episodic_return", 10.0}, {"charts/episodes", 1.0}}));
  scalars.on_actor(0, line(3, {{"charts/epsilon", 0.25}}));
  EXPECT_THAT(scalars.take(), IsEmpty());
  scalars.on_actor(1, line(1, {{"charts/episodic_return", 20.0}, {"charts/episodes", 3.0}}));
  EXPECT_THAT(scalars.take(),
              ElementsAre(StepScalars{1024, {{"train/mop/reward_per_episode", 17.5}}}));
  scalars.on_actor(1, line(3, {{"charts/epsilon", 0.75}}));
  EXPECT_THAT(scalars.take(), ElementsAre(epsilon(2048, 0.5)));
}

TEST(TrainingScalars, NeverGoBackWhenOneActorIsStartedAgain) {
  TrainingScalars scalars{RunConfig()};
  // Actor 1 dies before it tells of round 1, and tells of round 3 twice.
  scalars.on_actor(0, line(1, {{"charts/epsilon", 1.0}}));
  scalars.on_actor(0, line(3, {{"charts/epsilon", 0.5}}));
  scalars.on_actor(1, line(3, {{"charts/epsilon", 0.5}}));
  EXPECT_THAT(scalars.take(), ElementsAre(epsilon(1024, 1.0), epsilon(2048, 0.5)));
  scalars.on_actor(1, line(3, {{"charts/epsilon", 9.0}}));
  scalars.on_actor(0, line(3, {{"charts/epsilon", 9.0}}));
  EXPECT_THAT(scalars.take(), IsEmpty());
}

TEST(TrainingScalars, ComeAgainAfterAllWentBack) {
  TrainingScalars scalars{RunConfig()};
  for (const std::uint64_t round : {1, 3}) {
    for (const int actor : {0, 1}) scalars.on_actor(actor, line(round, {{"charts/epsilon", 1.0}}));
    scalars.on_learner(line(round, {{"losses/td_loss", 1.0}}));
  }
  scalars.on_actor(0, line(5, {{"charts/epsilon", 1.0}}));
  scalars.take();
  scalars.go_back_to(1024);
  for (const std::uint64_t round : {1, 3}) {
    for (const int actor : {0, 1}) scalars.on_actor(actor, line(round, {{"charts/epsilon", 2.0}}));
    scalars.on_learner(line(round, {{"losses/td_loss", 2.0}}));
  }
  EXPECT_THAT(scalars.take(), ElementsAre(epsilon(2048, 2.0), loss(2048, 2.0)));
}

}  // namespace
}  // namespace corridor::cluster
