// SPDX-License-Identifier: Apache-2.0
#include "cluster/pictures/clip.h"

#include <gtest/gtest.h>

#include "tests/support/driven.h"

namespace corridor::cluster {
namespace {

using testing_support::driven_episode;

TEST(Clip, IsAStretchInWholeStepsAndKnowsTheCollisionOnlyAtItsEnd) {
  const Clip middle = clip_of(driven_episode(7), "middle", 2.0, 4.0);
  EXPECT_EQ(middle.trace.steps.size(), 3u);
  EXPECT_EQ(middle.start_s, 2.0);
  EXPECT_EQ(middle.duration_s(), 2.0);
  EXPECT_FALSE(middle.trace.collision);
  const Clip end = clip_of(driven_episode(7), "end", 4.0, 99.0);
  EXPECT_EQ(end.trace.steps.size(), 3u);
  EXPECT_TRUE(end.trace.collision);
  const Clip before = clip_of(driven_episode(7), "before", -3.0, 2.0);
  EXPECT_EQ(before.start_s, 0.0);
  EXPECT_EQ(clip_of(driven_episode(1), "one", 0.0, 9.0).duration_s(), 0.0);
}

TEST(Clip, PutsVehiclesBetweenSimulatedInstants) {
  const Clip clip = clip_of(driven_episode(4), "clip", 0.0, 3.0);
  EXPECT_EQ(clip.scene_at(0.0).ego.s_m, 0.0);
  EXPECT_DOUBLE_EQ(clip.scene_at(0.25).ego.s_m, 2.0);
  EXPECT_DOUBLE_EQ(clip.scene_at(0.5).ego.s_m, 4.0);
  EXPECT_DOUBLE_EQ(clip.scene_at(0.5).ego.yaw_rad, 0.1);
  EXPECT_DOUBLE_EQ(clip.scene_at(0.75).ego.s_m, 7.0);
  EXPECT_DOUBLE_EQ(clip.scene_at(1.0).ego.s_m, 10.0);
  EXPECT_DOUBLE_EQ(clip.scene_at(99.0).ego.s_m, 30.0);
  EXPECT_EQ(clip.scene_at(1.5).others.size(), 1u) << "8 has not come yet";
  EXPECT_EQ(clip.scene_at(2.5).others.size(), 2u);
}

}  // namespace
}  // namespace corridor::cluster
