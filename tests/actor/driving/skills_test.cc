// SPDX-License-Identifier: Apache-2.0
#include "actor/driving/skills.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "actor/driving/action.h"
#include "actor/driving/observation.h"
#include "actor/driving/random_bp.h"
#include "tests/actor/driving/more_skills.h"
#include "tests/actor/driving/scenes.h"

namespace corridor::driving {
namespace {

using testing::ElementsAre;

TEST(Skills, OfThePaperHaveTheirNamedPlaces) {
  EXPECT_EQ(skill_of(Command::kKeep).name, std::string("keep"));
  EXPECT_EQ(skill_of(Command::kLeft).name, std::string("left"));
  EXPECT_EQ(skill_of(Command::kRight).name, std::string("right"));
  EXPECT_EQ(skill_of(Command::kKeep).lane_change, 0);
  EXPECT_EQ(skill_of(Command::kLeft).lane_change, 1);
  EXPECT_EQ(skill_of(Command::kRight).lane_change, -1);
}

TEST(Skills, OfThePaperShowTheirOwnWindowToTheSharedMop) {
  const Ego ego = ego_in_corridor(7);
  EXPECT_EQ(window_for(Command::kKeep, ego, kSettings).first, 5);
  EXPECT_EQ(window_for(Command::kLeft, ego, kSettings).first, 6);
  EXPECT_EQ(window_for(Command::kRight, ego, kSettings).first, 4);
  for (const Command command : {Command::kKeep, Command::kLeft, Command::kRight})
    EXPECT_EQ(window_for(command, ego, kSettings).network, NetworkId::kMop);
}

TEST(SkillsDeathTest, ACommandOutsideTheTableIsABug) {
  EXPECT_DEATH(window_for(kHalfLeft, ego_in_corridor(7), kSettings), "command 3 of 3");
}

TEST(Feasible, TurnsARequestForAMissingLaneIntoKeep) {
  EXPECT_EQ(feasible(Command::kRight, ego_in_corridor(4), kSettings), Command::kKeep);
  EXPECT_EQ(feasible(Command::kLeft, ego_in_corridor(10), kSettings), Command::kKeep);
}

TEST(Feasible, LeavesEveryOtherCommand) {
  for (const Command command : {Command::kKeep, Command::kLeft, Command::kRight})
    EXPECT_EQ(feasible(command, ego_in_corridor(7), kSettings), command);
  EXPECT_EQ(feasible(Command::kLeft, ego_in_corridor(4), kSettings), Command::kLeft);
  EXPECT_EQ(feasible(Command::kRight, ego_in_corridor(10), kSettings), Command::kRight);
}

TEST(MoreSkills, AFurtherRowIsAskedForSeenAndDrivenLikeTheOthers) {
  const Skills skills = kMoreSkills;
  EXPECT_EQ(feasible(kHalfLeft, ego_in_corridor(7), kSettings, skills), kHalfLeft);
  EXPECT_EQ(feasible(kHalfLeft, ego_in_corridor(12), kSettings, skills), Command::kKeep);

  const Window window = window_for(kHalfLeft, ego_in_corridor(7), kSettings, skills);
  EXPECT_EQ(window.first + window.middle(), 9) << "the leftmost corridor of the lane";
  EXPECT_EQ(window.network, NetworkId::kBp) << "whichever its row names";

  const StepAction action = unpack(pack(kHalfLeft, 17, 4), 4);
  EXPECT_EQ(action.command, kHalfLeft);
  EXPECT_EQ(action.mop_action, 17);

  std::vector<float> observation(static_cast<std::size_t>(bp_shape(3, 4).observations));
  observe_bp({ego_in_corridor(7), {}}, kHalfLeft, kSettings, observation, 4);
  const auto previous = observation.begin() + BpIndex::previous_command(3);
  EXPECT_THAT(std::vector<float>(previous, previous + 4), ElementsAre(0, 0, 0, 1));
  EXPECT_EQ(observation[static_cast<std::size_t>(BpIndex::lane(3, 1, 4))], 1.0f) << "own lane";
}

TEST(MoreSkills, TheRandomBpAsksForAFurtherOneToo) {
  DrivingSettings settings = kSettings;
  settings.random_bp.flicker_share = 1.0;
  RandomBp bp(settings, kMoreSkills);
  bp.begin_episode(1);
  int asked = 0;
  for (int step = 0; step < 400; ++step) {
    asked += bp.decide(situation_of({ego_in_corridor(7), {}}, settings, step)) == kHalfLeft;
  }
  EXPECT_GT(asked, 50);
  EXPECT_LT(asked, 200);
}

TEST(KeepWindow, IsTheLaneWithThreeOfFiveOpenWhereverInItTheEgoIs) {
  for (int corridor = 0; corridor < 15; ++corridor) {
    const Window window = keep_window(0, ego_in_corridor(corridor), kSettings);
    EXPECT_EQ(window.first, corridor / 5 * 5);
    EXPECT_THAT(window.open, ElementsAre(false, true, true, true, false));
  }
}

TEST(KeepWindow, OpensOnlyTheMiddleForAnEgoAsWideAsTheLane) {
  DrivingSettings settings = kSettings;
  settings.ego.width_m = 3.2;
  EXPECT_THAT(keep_window(0, ego_in_corridor(7), settings).open,
              ElementsAre(false, false, true, false, false));
}

TEST(KeepWindow, AllowsABodyToTouchTheLane) {
  DrivingSettings settings = kSettings;
  settings.ego.width_m = 1.92;  // 0.96 m each side of corridor 1's centre at 0.96 m
  EXPECT_THAT(keep_window(0, ego_in_corridor(7), settings).open,
              ElementsAre(false, true, true, true, false));
}

TEST(SwitchWindow, PutsTheEgoOneCorridorOffTheMiddleAgainstTheDirection) {
  for (int corridor = 1; corridor < 14; ++corridor) {
    const Window left = switch_window(1, ego_in_corridor(corridor), kSettings);
    EXPECT_EQ(left.position_of(corridor), left.middle() - 1);
    const Window right = switch_window(-1, ego_in_corridor(corridor), kSettings);
    EXPECT_EQ(right.position_of(corridor), right.middle() + 1);
  }
}

TEST(SwitchWindow, IsOpenAcrossLaneLines) {
  const Window window = switch_window(1, ego_in_corridor(7), kSettings);
  EXPECT_EQ(window.first, 6);
  EXPECT_THAT(window.open, ElementsAre(true, true, true, true, true));
}

TEST(SwitchWindow, IsClosedOffTheRoadAndWhereTheBodyWouldLeaveIt) {
  const Window right = switch_window(-1, ego_in_corridor(2), kSettings);
  EXPECT_EQ(right.first, -1);
  EXPECT_THAT(right.open, ElementsAre(false, false, true, true, true));
  const Window left = switch_window(1, ego_in_corridor(13), kSettings);
  EXPECT_EQ(left.first, 12);
  EXPECT_THAT(left.open, ElementsAre(true, true, false, false, false));
}

TEST(SwitchWindow, ShiftsWithTheEgo) {
  for (int corridor = 7; corridor < 12; ++corridor)
    EXPECT_EQ(switch_window(1, ego_in_corridor(corridor), kSettings).first, corridor - 1);
}

TEST(Window, KnowsItsCorridors) {
  const Window window = switch_window(-1, ego_in_corridor(2), kSettings);
  EXPECT_TRUE(window.contains(-1));
  EXPECT_TRUE(window.contains(3));
  EXPECT_FALSE(window.contains(4));
  EXPECT_FALSE(window.is_open(-1));
  EXPECT_TRUE(window.is_open(1));
  EXPECT_FALSE(window.is_open(4));
}

}  // namespace
}  // namespace corridor::driving
