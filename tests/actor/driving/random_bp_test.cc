// SPDX-License-Identifier: Apache-2.0
#include "actor/driving/random_bp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "tests/actor/driving/scenes.h"

namespace corridor::driving {
namespace {

// Drives over an empty road as the random BP asks, one corridor a step.
struct RandomDrive {
  std::vector<Command> commands;
  int lane_changes = 0;
};

RandomDrive drive_at_random(RandomBp& bp, std::uint64_t episode_seed, int steps) {
  const Lanes lanes(kSettings);
  bp.begin_episode(episode_seed);
  RandomDrive drive;
  int corridor = 7;
  for (int step = 0; step < steps; ++step) {
    const Ego ego = ego_at(lanes.corridor_centre_m(corridor), 13.89);
    const Command command = bp.decide({{ego, {}}, {}, Command::kKeep, step});
    EXPECT_EQ(command, feasible(command, ego, kSettings));
    drive.commands.push_back(command);
    const Window window = window_for(command, ego, kSettings);
    const int off = window.middle() - window.position_of(corridor);
    const int next = corridor + std::clamp(off, -1, 1);
    drive.lane_changes += lanes.lane_of(next) != lanes.lane_of(corridor);
    corridor = next;
  }
  return drive;
}

TEST(RandomBp, IsAFunctionOfTheEpisodesSeed) {
  RandomBp one(kSettings);
  RandomBp two(kSettings);
  drive_at_random(two, 99, 500);  // what came before does not matter
  EXPECT_EQ(drive_at_random(one, 7, 1000).commands, drive_at_random(two, 7, 1000).commands);
  EXPECT_NE(drive_at_random(one, 7, 1000).commands, drive_at_random(two, 8, 1000).commands);
}

TEST(RandomBp, ChangesLanesAboutOnceInAHundredSteps) {
  RandomBp bp(kSettings);
  int lane_changes = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed)
    lane_changes += drive_at_random(bp, seed, 1000).lane_changes;
  // 1000 hundreds of steps; a goal may be two lanes away, and flicker changes lanes too.
  EXPECT_GT(lane_changes, 800);
  EXPECT_LT(lane_changes, 2000);
}

TEST(RandomBp, AsksForEveryCommandAndKeepsMostOfTheTime) {
  RandomBp bp(kSettings);
  std::map<Command, int> counts;
  for (std::uint64_t seed = 0; seed < 100; ++seed)
    for (const Command command : drive_at_random(bp, seed, 1000).commands) ++counts[command];
  EXPECT_GT(counts[Command::kKeep], 70'000);
  EXPECT_GT(counts[Command::kLeft], 2'500);
  EXPECT_NEAR(counts[Command::kLeft], counts[Command::kRight], 1'500);
}

TEST(RandomBp, FlickersOnlyAsOftenAsItIsTold) {
  const auto short_commands = [](double flicker_share) {
    DrivingSettings settings = kSettings;
    settings.random_bp.flicker_share = flicker_share;
    RandomBp bp(settings);
    int changes = 0;
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
      const auto commands = drive_at_random(bp, seed, 1000).commands;
      for (std::size_t i = 1; i < commands.size(); ++i) changes += commands[i] != commands[i - 1];
    }
    return changes;
  };
  // Without flicker the command changes twice a lane change.
  EXPECT_LT(short_commands(0.0), 30 * 35);
  EXPECT_GT(short_commands(0.5), 2 * short_commands(0.0));
}

TEST(RandomBp, GivesUpAGoalThatTheEgoCannotReach) {
  DrivingSettings settings = kSettings;
  settings.random_bp.flicker_share = 0.0;
  RandomBp bp(settings);
  bp.begin_episode(3);
  // The ego never moves: goals on both sides are asked for, one after the other.
  std::map<Command, int> counts;
  for (int step = 0; step < 5000; ++step)
    ++counts[bp.decide({{ego_in_the_middle(), {}}, {}, Command::kKeep, step})];
  EXPECT_GT(counts[Command::kLeft], 500);
  EXPECT_GT(counts[Command::kRight], 500);
}

TEST(RandomBp, KeepsTheOnlyLane) {
  DrivingSettings settings = kSettings;
  settings.road.lanes = 1;
  RandomBp bp(settings);
  bp.begin_episode(3);
  for (int step = 0; step < 1000; ++step)
    ASSERT_EQ(bp.decide({{ego_at(1.6, 10.0), {}}, {}, Command::kKeep, step}), Command::kKeep);
}

}  // namespace
}  // namespace corridor::driving
