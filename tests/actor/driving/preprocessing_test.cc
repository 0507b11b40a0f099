#include "actor/driving/preprocessing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/actor/driving/scenes.h"

namespace corridor::driving {
namespace {

using testing::ElementsAre;

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
