// SPDX-License-Identifier: Apache-2.0
#include "actor/driving/observation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "actor/driving/prediction.h"
#include "actor/driving/skills.h"
#include "proto/settings/transition.h"
#include "tests/actor/driving/scenes.h"

namespace corridor::driving {
namespace {

// Without clearances, but where a test is about them.
const DrivingSettings kNoClearances = [] {
  DrivingSettings settings = kSettings;
  settings.planner.clearance_steps = 0;
  return settings;
}();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

float gap(double gap_m) { return static_cast<float>(gap_m / (gap_m + 15.0)); }

std::vector<float> mop_observation(const Scene& scene, Command command) {
  std::vector<float> out(28, kNaN);
  observe_mop(scene, corridor_gaps(scene, kNoClearances),
              window_for(command, scene.ego, kNoClearances), kNoClearances, out);
  return out;
}

std::vector<float> bp_observation(const Scene& scene, Command previous) {
  std::vector<float> out(24, kNaN);
  observe_bp(scene, previous, kNoClearances, out);
  return out;
}

void expect_near(const std::vector<float>& got, const std::vector<float>& expected) {
  ASSERT_EQ(got.size(), expected.size());
  for (std::size_t i = 0; i < got.size(); ++i)
    EXPECT_NEAR(got[i], expected[i], 1e-6) << "index " << i;
}

TEST(Observations, AreAsLongAsTheirShapesSay) {
  EXPECT_EQ(mop_shape(5, 3, 0).observations, 28);
  EXPECT_EQ(mop_shape(5, 3, 2).observations, 40);
  EXPECT_EQ(bp_shape(3).observations, 24);
}

TEST(MopObservation, ShowsTheWayAroundAnObjectAtTheLanesEdge) {
  const Scene scene{ego_in_the_middle(),
                    {{.id = 1, .s_m = 134.0, .d_m = 3.585, .length_m = 9.0, .width_m = 0.75}}};
  const std::vector<float> observation = mop_observation(scene, Command::kKeep);
  const auto front_gap = [&](int position) {
    return observation[static_cast<std::size_t>(MopIndex::corridor(position) +
                                                MopIndex::kFrontGap)];
  };
  EXPECT_NEAR(front_gap(1), gap(25.0), 1e-6);
  EXPECT_NEAR(front_gap(2), gap(25.0), 1e-6);
  EXPECT_NEAR(front_gap(3), gap(100.0), 1e-6);
}

// A leader 25 m ahead at 6 m/s, a follower 10 m behind at 20 m/s, both in the lane's middle.
Scene between_two() {
  Ego ego = ego_in_the_middle();
  ego.set_point_mps = 12.0;
  return {ego,
          {{.id = 1, .s_m = 130.0, .d_m = 4.8, .speed_mps = 6.0},
           {.id = 2, .s_m = 85.0, .d_m = 4.8, .speed_mps = 20.0}}};
}

TEST(MopObservation, HasEveryIndexOfTheTable) {
  const float front = gap(25.0);
  const float back = gap(10.0);
  expect_near(mop_observation(between_two(), Command::kKeep), {10.0f / 13.89f,
                                                               12.0f / 13.89f,
                                                               1.0f,  //
                                                               0,
                                                               0,
                                                               0,
                                                               0,
                                                               0,  // closed
                                                               0,
                                                               front,
                                                               -0.5f,
                                                               back,
                                                               -1.0f,  //
                                                               1,
                                                               front,
                                                               -0.5f,
                                                               back,
                                                               -1.0f,  // the ego's
                                                               0,
                                                               front,
                                                               -0.5f,
                                                               back,
                                                               -1.0f,  //
                                                               0,
                                                               0,
                                                               0,
                                                               0,
                                                               0});
}

TEST(MopObservation, EndsWithTheScaledClearancesHoweverTheWindowLies) {
  DrivingSettings settings = kSettings;
  settings.planner.clearance_steps = 2;
  const Scene scene = {ego_in_the_middle(),
                       {{.id = 3, .s_m = 100.0, .d_m = 4.8 - 2.4, .speed_mps = 10.0}}};
  std::vector<double> clearances_m(12);
  predicted_clearances_m(scene, settings, clearances_m);
  for (const Command command : {Command::kKeep, Command::kLeft}) {
    std::vector<float> out(40, kNaN);
    observe_mop(scene, corridor_gaps(scene, settings), window_for(command, scene.ego, settings),
                settings, out);
    for (std::size_t i = 0; i < clearances_m.size(); ++i) {
      EXPECT_EQ(out[28 + i], static_cast<float>(clearances_m[i] / 2.0)) << i;
    }
    EXPECT_NEAR(out[28 + 4], 0.3, 1e-6);  // 0.6 m between the sides, no corridor change, braking
  }
}

TEST(MopObservation, ShowsASwitchWindowFromRightToLeft) {
  const float front = gap(25.0);
  const float back = gap(10.0);
  const float none = gap(100.0);
  // Corridors 6 to 10 and, for the right, 4 to 8; the vehicles occupy 4 to 10.
  expect_near(mop_observation(between_two(), Command::kLeft), {10.0f / 13.89f,
                                                               12.0f / 13.89f,
                                                               1.0f,  //
                                                               0,
                                                               front,
                                                               -0.5f,
                                                               back,
                                                               -1.0f,  //
                                                               1,
                                                               front,
                                                               -0.5f,
                                                               back,
                                                               -1.0f,  //
                                                               0,
                                                               front,
                                                               -0.5f,
                                                               back,
                                                               -1.0f,  //
                                                               0,
                                                               front,
                                                               -0.5f,
                                                               back,
                                                               -1.0f,  //
                                                               0,
                                                               front,
                                                               -0.5f,
                                                               back,
                                                               -1.0f});
  Scene scene = between_two();
  scene.others.resize(1);
  scene.others[0].d_m = 8.0;  // in corridors 9 and further left
  expect_near(mop_observation(scene, Command::kLeft), {10.0f / 13.89f,
                                                       12.0f / 13.89f,
                                                       1.0f,  //
                                                       0,
                                                       none,
                                                       0,
                                                       none,
                                                       0,  //
                                                       1,
                                                       none,
                                                       0,
                                                       none,
                                                       0,  //
                                                       0,
                                                       none,
                                                       0,
                                                       none,
                                                       0,  //
                                                       0,
                                                       front,
                                                       -0.5f,
                                                       none,
                                                       0,  //
                                                       0,
                                                       front,
                                                       -0.5f,
                                                       none,
                                                       0});
}

TEST(MopObservation, ShowsTheEgoInAClosedCorridor) {
  Scene scene = between_two();
  scene.ego.d_m = Lanes(kNoClearances).corridor_centre_m(9);
  const auto out = mop_observation(scene, Command::kKeep);
  const int base = MopIndex::corridor(4);
  EXPECT_EQ(out[static_cast<std::size_t>(base + MopIndex::kInCorridor)], 1.0f);
  EXPECT_EQ(out[static_cast<std::size_t>(base + MopIndex::kFrontGap)], 0.0f);
}

TEST(BpObservation, HasEveryIndexOfTheTable) {
  Scene scene = between_two();
  scene.ego.d_m = 5.6;
  scene.others.push_back({.id = 3, .s_m = 101.0, .d_m = 1.6, .speed_mps = 11.0});
  scene.others.push_back({.id = 4, .s_m = 150.0, .d_m = 8.0, .speed_mps = 10.0});
  expect_near(bp_observation(scene, Command::kRight), {10.0f / 13.89f,
                                                       12.0f / 13.89f,
                                                       0.5f,  //
                                                       0,
                                                       1,
                                                       0,  // lane
                                                       0,
                                                       0,
                                                       1,  // previous command
                                                       1,
                                                       0,
                                                       0.125f,
                                                       0,
                                                       -0.125f,  // right: a vehicle beside
                                                       1,
                                                       gap(25.0),
                                                       -0.5f,
                                                       gap(10.0),
                                                       -1.0f,  // own
                                                       1,
                                                       gap(45.0),
                                                       0.0f,
                                                       gap(100.0),
                                                       0.0f});  // left
}

TEST(BpObservation, IsZeroForLanesThatDoNotExist) {
  Scene scene{ego_in_the_middle(), {}};
  scene.ego.d_m = 1.6;
  const float none = gap(100.0);
  const float speed = 10.0f / 13.89f;
  expect_near(bp_observation(scene, Command::kKeep),
              {speed, speed, 0.0f, 1, 0, 0, 1,    0, 0,  //
               0,     0,     0,    0, 0, 1, none, 0, none, 0, 1, none, 0, none, 0});
  scene.ego.d_m = 8.0;
  expect_near(bp_observation(scene, Command::kLeft),
              {speed, speed, 0.0f, 0,    0, 1, 0,    1, 0,  //
               1,     none,  0,    none, 0, 1, none, 0, none, 0, 0, 0, 0, 0, 0});
}

TEST(BpObservation, CountsTheOffsetFromTheLanesCentreToTheLeft) {
  Scene scene{ego_in_the_middle(), {}};
  scene.ego.d_m = 3.2;
  EXPECT_NEAR(bp_observation(scene, Command::kKeep)[BpIndex::kOffset], -1.0f, 1e-6);
  scene.ego.d_m = 6.3999;
  EXPECT_NEAR(bp_observation(scene, Command::kKeep)[BpIndex::kOffset], 1.0f, 1e-3);
}

TEST(Observations, AreOfOrderOneInRandomScenes) {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    const Scene scene = random_scene(seed, kNoClearances);
    for (const Command command : {Command::kKeep, Command::kLeft, Command::kRight}) {
      for (const auto& out : {mop_observation(scene, command), bp_observation(scene, command)})
        for (const float x : out) ASSERT_TRUE(x >= -1.0f && x <= 1.0f) << x << " in scene " << seed;
    }
  }
}

TEST(Observations, FollowOtherNumbersOfLanesAndCorridors) {
  DrivingSettings settings = kNoClearances;
  settings.road.lanes = 5;
  settings.planner.corridors_per_lane = 3;
  const Scene scene = random_scene(1, settings);
  std::vector<float> mop(18, kNaN);
  observe_mop(scene, corridor_gaps(scene, settings),
              window_for(Command::kKeep, scene.ego, settings), settings, mop);
  std::vector<float> bp(26, kNaN);
  observe_bp(scene, Command::kKeep, settings, bp);
  for (const float x : mop) EXPECT_TRUE(std::isfinite(x));
  for (const float x : bp) EXPECT_TRUE(std::isfinite(x));
}

TEST(ObservationsDeathTest, RefuseARowOfAnotherLength) {
  const Scene scene = between_two();
  std::vector<float> out(27);
  EXPECT_DEATH(observe_bp(scene, Command::kKeep, kNoClearances, out), "27 floats for 24");
  EXPECT_DEATH(
      observe_mop(scene, corridor_gaps(scene, kNoClearances),
                  window_for(Command::kKeep, scene.ego, kNoClearances), kNoClearances, out),
      "27 floats for 28");
}

}  // namespace
}  // namespace corridor::driving
