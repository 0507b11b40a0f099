// SPDX-License-Identifier: Apache-2.0
#include "actor/driving/bypass.h"

#include <gtest/gtest.h>

#include "tests/actor/driving/scenes.h"

namespace corridor::driving {
namespace {

// A stopped object at the right edge of the middle lane, 5 m ahead of the ego.
constexpr Vehicle kObject = {.id = 3, .s_m = 105.0, .d_m = 3.6, .length_m = 1.6, .width_m = 0.65};

Scene scene(double ego_s_m, double ego_d_m, const Vehicle& other = kObject) {
  Ego ego = ego_in_the_middle();
  ego.s_m = ego_s_m;
  ego.d_m = ego_d_m;
  return {ego, {{.id = 1, .s_m = 40.0, .d_m = 1.6}, other}};
}

TEST(Bypass, IsCountedInTheStepInWhichTheFrontBumperGoesPast) {
  EXPECT_EQ(bypasses(scene(90.0, 5.44), scene(100.0, 5.44), kSettings), 0);
  EXPECT_EQ(bypasses(scene(100.0, 5.44), scene(110.0, 5.44), kSettings), 1);
  EXPECT_EQ(bypasses(scene(110.0, 5.44), scene(120.0, 5.44), kSettings), 0);
}

TEST(Bypass, IsNoneFromAnotherLaneOrReachingIntoOne) {
  EXPECT_EQ(bypasses(scene(100.0, 8.0), scene(110.0, 8.0), kSettings), 0);
  EXPECT_EQ(bypasses(scene(100.0, 1.6), scene(110.0, 1.6), kSettings), 0);
  EXPECT_EQ(bypasses(scene(100.0, 5.6), scene(110.0, 5.6), kSettings), 0);
  EXPECT_EQ(bypasses(scene(100.0, 5.44), scene(110.0, 6.08), kSettings), 0);
  EXPECT_EQ(bypasses(scene(100.0, 6.08), scene(110.0, 5.44), kSettings), 0);
}

TEST(Bypass, IsNoneOfAVehicleThatOvertakesOrHasJustCome) {
  Vehicle passing = kObject;
  passing.s_m = 95.0;
  EXPECT_EQ(bypasses(scene(100.0, 5.44), scene(101.0, 5.44, kObject), kSettings), 0);
  EXPECT_EQ(bypasses(scene(100.0, 5.44, passing), scene(101.0, 5.44, kObject), kSettings), 0);
  Scene without = scene(100.0, 5.44);
  without.others.pop_back();
  EXPECT_EQ(bypasses(without, scene(110.0, 5.44), kSettings), 0);
}

}  // namespace
}  // namespace corridor::driving
