// SPDX-License-Identifier: Apache-2.0
#include "proto/settings/schedule.h"

#include <gtest/gtest.h>

#include <vector>

#include "proto/base/failure.h"

namespace corridor {
namespace {

// Two actors of 100 steps a round: 200 a round; 5 rounds of the MoP, 3 of the BP.
RunConfig small() {
  RunConfig config;
  config.run.actors = 2;
  config.schedule.steps_per_round = 100;
  config.schedule.selection_every_steps = 400;
  config.schedule.checkpoint_every_steps = 600;
  config.dqn[0].steps = 1000;
  config.dqn[1].steps = 401;
  return config;
}

std::vector<std::uint64_t> rounds_where(const Schedule& schedule,
                                        bool (Schedule::*holds)(std::uint64_t) const) {
  std::vector<std::uint64_t> rounds;
  for (std::uint64_t round = 0; round < schedule.rounds(); ++round) {
    if ((schedule.*holds)(round)) rounds.push_back(round);
  }
  return rounds;
}

TEST(Schedule, BudgetsAreRoundedUpToWholeRounds) {
  const Schedule schedule(small());
  EXPECT_EQ(schedule.steps_per_round(), 200);
  EXPECT_EQ(schedule.rounds_of(Phase::kMop), 5U);
  EXPECT_EQ(schedule.rounds_of(Phase::kBp), 3U);
  EXPECT_EQ(schedule.rounds(), 8U);
}

TEST(Schedule, ABudgetBelowARoundIsOneRound) {
  RunConfig config = small();
  config.dqn[0].steps = 1;
  EXPECT_EQ(Schedule(config).rounds_of(Phase::kMop), 1U);
}

TEST(Schedule, TheBpsRoundsFollowTheMops) {
  const Schedule schedule(small());
  EXPECT_EQ(schedule.first_round(Phase::kMop), 0U);
  EXPECT_EQ(schedule.first_round(Phase::kBp), 5U);
  EXPECT_EQ(schedule.phase_of(0), Phase::kMop);
  EXPECT_EQ(schedule.phase_of(4), Phase::kMop);
  EXPECT_EQ(schedule.phase_of(5), Phase::kBp);
  EXPECT_EQ(schedule.phase_of(7), Phase::kBp);
}

TEST(Schedule, StepsAndProgressCountWithinThePhase) {
  const Schedule schedule(small());
  EXPECT_EQ(schedule.phase_steps_after(0), 200);
  EXPECT_EQ(schedule.phase_steps_after(4), 1000);
  EXPECT_EQ(schedule.phase_steps_after(5), 200);
  EXPECT_EQ(schedule.phase_steps_after(7), 600);
  EXPECT_EQ(schedule.annealed(0), 0.0);
  EXPECT_EQ(schedule.annealed(4), 0.8);
  EXPECT_EQ(schedule.annealed(5), 0.0);
}

TEST(Schedule, WhatIsAnnealedOverOtherStepsThanThePhasesStaysAtItsEnd) {
  RunConfig config = small();
  config.dqn[0].annealing_steps = 400;  // two of five rounds
  const Schedule schedule(config);
  EXPECT_EQ(schedule.annealed(1), 0.5);
  EXPECT_EQ(schedule.annealed(2), 1.0);
  EXPECT_EQ(schedule.annealed(4), 1.0);
  EXPECT_EQ(schedule.annealed(5), 0.0) << "the other phase's";
}

TEST(Schedule, ARoundIsDrivenWithTheWeightsOfTheBlockBeforeTheLast) {
  const Schedule schedule(small());
  const std::vector<std::uint64_t> versions = {0, 0, 1, 2, 3, 5, 5, 6};
  for (std::uint64_t round = 0; round < schedule.rounds(); ++round) {
    EXPECT_EQ(schedule.weights_version(round), versions[round]) << round;
    // Published by block version - 1, which needs rounds up to that one only: no deadlock.
    EXPECT_LE(versions[round], round);
  }
}

TEST(Schedule, SelectionsAndTheLastOfEachPhase) {
  EXPECT_EQ(rounds_where(Schedule(small()), &Schedule::selects_in),
            (std::vector<std::uint64_t>{1, 3, 4, 6, 7}));
}

TEST(Schedule, CheckpointsAndTheLast) {
  EXPECT_EQ(rounds_where(Schedule(small()), &Schedule::checkpoints_after),
            (std::vector<std::uint64_t>{2, 5, 7}));
}

TEST(ScheduleDeathTest, RoundsBeyondTheLastAreABug) {
  EXPECT_DEATH(Schedule(small()).phase_of(8), "round 8 of 8");
}

}  // namespace
}  // namespace corridor
