// SPDX-License-Identifier: Apache-2.0
#include "cluster/watch/training_progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/run/metrics.h"
#include "proto/run/run_directory.h"
#include "proto/system/time_account.h"

namespace corridor::cluster {
namespace {

using testing::AllOf;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::Pair;
using testing::UnorderedElementsAre;

constexpr int kCores = 2;

// 10 rounds of MoP and 10 of BP, 2 actors x 100 steps each.
RunConfig config() {
  RunConfig config;
  config.run.actors = 2;
  config.schedule.steps_per_round = 100;
  config.dqn[0].steps = 2000;
  config.dqn[1].steps = 2000;
  return config;
}

class Progress : public testing::Test {
 protected:
  static MetricsLine line(const char* phase, std::uint64_t round,
                          std::map<std::string, double, std::less<>> values = {}) {
    return {phase, round, 0, std::move(values)};
  }
  TrainingProgress progress_{Schedule(config()), config().run.actors, 0, kCores, 0.0};
};

TEST_F(Progress, CountsStepsOverBothPhases) {
  EXPECT_EQ(progress_.steps_done(), 0);
  progress_.on(kLearnerName, line("MoP", 4), 1.0);
  EXPECT_EQ(progress_.steps_done(), 1000);
  progress_.on(kLearnerName, line("BP", 19), 3.0);
  EXPECT_EQ(progress_.steps_done(), 4000);
}

TEST_F(Progress, ShowsPhaseShareSpeedAndTimeLeft) {
  progress_.on(kLearnerName, line("MoP", 4), 2.0);
  EXPECT_EQ(progress_.lines()[0],
            "MoP [#####...............]  25.0 %  1,000 of 4,000 steps  500 steps/s  6 s left");
}

TEST_F(Progress, KnowsNoSpeedBeforeTheFirstRound) {
  EXPECT_EQ(progress_.lines()[0], "MoP [....................]   0.0 %  0 of 4,000 steps");
  EXPECT_EQ(progress_.lines()[1], "starting");
}

TEST_F(Progress, TakesTheSpeedFromTheLastHalfMinute) {
  progress_.on(kLearnerName, line("MoP", 0), 100.0);  // a slow start: 2 steps/s
  progress_.on(kLearnerName, line("MoP", 1), 131.0);
  progress_.on(kLearnerName, line("MoP", 9), 132.0);
  progress_.on(kLearnerName, line("BP", 14), 162.0);
  // What counts begins at (131 s, 400 steps).
  EXPECT_THAT(progress_.lines()[0], HasSubstr("  84 steps/s"));
}

TEST_F(Progress, AResumedTrainingBeginsWhereItsCheckpointIs) {
  TrainingProgress resumed(Schedule(config()), config().run.actors, 12, kCores, 50.0);
  EXPECT_EQ(resumed.steps_done(), 2400);
  EXPECT_THAT(resumed.lines()[0], HasSubstr("BP  [############........]  60.0 %"));
  resumed.on(kLearnerName, line("BP", 12), 51.0);
  EXPECT_THAT(resumed.lines()[0], HasSubstr("  200 steps/s"));
}

TEST_F(Progress, AveragesOverTheActors) {
  progress_.on(kActorName,
               line("MoP", 0, {{metric::kRewardPer1000, 500.0}, {metric::kCollisionsPer1000, 2.0}}),
               1.0);
  progress_.on(kActorName,
               line("MoP", 0, {{metric::kRewardPer1000, 700.0}, {metric::kCollisionsPer1000, 1.0}}),
               1.0);
  EXPECT_THAT(progress_.lines()[1], HasSubstr("reward 600, collisions 1.5 per 1000 steps"));
}

TEST_F(Progress, ForgetsTheFiguresOfThePhaseBefore) {
  progress_.on(kActorName, line("MoP", 9, {{metric::kRewardPer1000, 500.0}}), 1.0);
  progress_.on(kLearnerName, line("BP", 10), 1.0);
  progress_.on(kActorName, line("MoP", 9, {{metric::kRewardPer1000, 500.0}}), 1.0);
  EXPECT_THAT(progress_.lines()[1], Not(HasSubstr("reward")));
}

TEST_F(Progress, NamesTheSideThatTheOtherWaitsFor) {
  const auto lines = [&](double for_actors, double for_weights, double for_replay) {
    TrainingProgress progress(Schedule(config()), config().run.actors, 0, kCores, 0.0);
    EXPECT_EQ(progress.lines().size(), 2u);
    progress.on(kLearnerName,
                line("MoP", 0,
                     {{time_metric(TimePart::kWaitForActors), for_actors},
                      {time_metric(TimePart::kWaitForReplay), for_replay}}),
                1.0);
    progress.on(kReplayName, line("MoP", 0, {{metric::kSamplesPerInsert, 31.96}}), 1.0);
    progress.on(kReplayName, line("BP", 0, {{metric::kSamplesPerInsert, 1.0}}), 1.0);
    progress.on(kActorName,
                line("MoP", 0,
                     {{time_metric(TimePart::kWaitForLearner), for_weights},
                      {time_metric(TimePart::kWaitForReplay), 0.01}}),
                1.0);
    return progress.lines();
  };
  EXPECT_THAT(lines(0.4, 0.03, 0.02),
              ElementsAre(testing::_, "32.0 samples per insert",
                          "waits: learner 40 % for actors, actors 3 % for weights; "
                          "bottleneck: the actors"));
  EXPECT_THAT(lines(0.03, 0.4, 0.02).back(), HasSubstr("bottleneck: the learner"));
  EXPECT_THAT(lines(0.03, 0.04, 0.3).back(),
              AllOf(HasSubstr("learner 30 % and actors 1 % for replay"),
                    HasSubstr("bottleneck: the replay server")));
  EXPECT_THAT(lines(0.03, 0.04, 0.02).back(), HasSubstr("bottleneck: none"));
}

TEST_F(Progress, NamesTheCoresWhenTheyAreBusyAndWhatTheyDo) {
  const auto times = [](const std::string& part, double share, double cpu_s, double for_others) {
    return std::map<std::string, double, std::less<>>{
        {part, share},
        {time_metric(TimePart::kWaitForLearner), for_others},
        {time_metric(TimePart::kWaitForActors), for_others},
        {kWallTimeMetric, 10.0},
        {kCpuTimeMetric, cpu_s},
        {kIoCpuTimeMetric, 0.0}};
  };
  const int actors = config().run.actors;
  // Two cores, of which the actors keep `busy` and the learner half of one.
  const auto line_for = [&](double busy) {
    TrainingProgress progress(Schedule(config()), config().run.actors, 0, 2, 0.0);
    progress.on(kLearnerName, line("MoP", 0, times(time_metric(TimePart::kUpdate), 0.8, 5.0, 0.2)),
                1.0);
    progress.on(
        kActorName,
        line("MoP", 0, times(time_metric(TimePart::kSimulate), 0.6, 10.0 * busy / actors, 0.4)),
        1.0);
    return progress.lines().back();
  };
  EXPECT_THAT(line_for(1.5), HasSubstr("bottleneck: the 2 cores: simulate 75 %, update 25 %"));
  EXPECT_THAT(line_for(0.5), HasSubstr("bottleneck: the learner: update 100 %"));
}

const MetricsValues kLine = {{metric::kStepsPerS, 900.0},
                             {time_metric(TimePart::kSimulate), 0.6},
                             {time_metric(TimePart::kWorld), 0.2},
                             {time_metric(TimePart::kWaitForLearner), 0.2},
                             {kWallTimeMetric, 10.0},
                             {kCpuTimeMetric, 4.0},
                             {kIoCpuTimeMetric, 1.0}};

TEST(CoreTime, IsProcessorTimeInProportionToThePartsThatDoNotWait) {
  const CoreTime parts = cores_by_part(kLine);
  EXPECT_THAT(parts, UnorderedElementsAre(Pair("simulate", DoubleNear(0.3, 1e-12)),
                                          Pair("world", DoubleNear(0.1, 1e-12)),
                                          Pair("io", DoubleNear(0.1, 1e-12))));
}

TEST(CoreTime, IsEmptyWithoutTimes) {
  EXPECT_TRUE(cores_by_part({}).empty());
  EXPECT_TRUE(cores_by_part({{time_metric(TimePart::kSimulate), 1.0}}).empty());
}

}  // namespace
}  // namespace corridor::cluster
