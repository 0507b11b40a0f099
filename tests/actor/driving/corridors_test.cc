// SPDX-License-Identifier: Apache-2.0
#include "actor/driving/corridors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/actor/driving/scenes.h"

namespace corridor::driving {
namespace {

Scene scene_with(const Vehicle& other) { return {ego_in_the_middle(), {other}}; }

// The corridors in which the vehicle is seen.
std::vector<int> occupied(const Vehicle& other) {
  std::vector<int> result;
  const auto gaps = corridor_gaps(scene_with(other), kSettings);
  for (int c = 0; c < static_cast<int>(gaps.size()); ++c) {
    const auto& g = gaps[static_cast<std::size_t>(c)];
    if (g.front_gap_m < 100.0 || g.back_gap_m < 100.0) result.push_back(c);
  }
  return result;
}

void expect_gaps(const CorridorGaps& gaps, double front_m, double front_mps, double back_m,
                 double back_mps) {
  EXPECT_NEAR(gaps.front_gap_m, front_m, 1e-9);
  EXPECT_NEAR(gaps.front_rate_mps, front_mps, 1e-9);
  EXPECT_NEAR(gaps.back_gap_m, back_m, 1e-9);
  EXPECT_NEAR(gaps.back_rate_mps, back_mps, 1e-9);
}

TEST(Lanes, CountFromTheRightAndClampToTheRoad) {
  const Lanes lanes(kSettings);
  EXPECT_EQ(lanes.corridors(), 15);
  EXPECT_DOUBLE_EQ(lanes.corridor_width_m(), 0.64);
  EXPECT_EQ(lanes.lane_at(0.1), 0);
  EXPECT_EQ(lanes.lane_at(4.8), 1);
  EXPECT_EQ(lanes.lane_at(-1.0), 0);
  EXPECT_EQ(lanes.lane_at(11.0), 2);
  EXPECT_EQ(lanes.corridor_at(-1.0), 0);
  EXPECT_EQ(lanes.corridor_at(11.0), 14);
  EXPECT_EQ(lanes.middle_of_lane(1), 7);
  EXPECT_DOUBLE_EQ(lanes.corridor_centre_m(7), lanes.lane_centre_m(1));
}

TEST(Lanes, FindEveryCorridorAndLaneFromItsCentre) {
  const Lanes lanes(kSettings);
  for (int c = 0; c < lanes.corridors(); ++c) {
    EXPECT_EQ(lanes.corridor_at(lanes.corridor_centre_m(c)), c);
    EXPECT_EQ(lanes.lane_at(lanes.corridor_centre_m(c)), lanes.lane_of(c));
  }
}

TEST(Lanes, PutALineIntoTheStripOnItsLeftWhateverTheRounding) {
  const Lanes lanes(kSettings);
  for (int c = 1; c < lanes.corridors(); ++c) {
    const double line_m = c * 0.64;
    for (const double d_m : {std::nextafter(line_m, 0.0), line_m, std::nextafter(line_m, 10.0)})
      EXPECT_EQ(lanes.corridor_at(d_m), c);
    EXPECT_EQ(lanes.corridor_at(line_m - 1e-6), c - 1);
  }
  EXPECT_EQ(lanes.lane_at(std::nextafter(3.2, 0.0)), 1);
}

TEST(CorridorGapsOfTheRoad, AreTheRangeWithoutVehicles) {
  const auto gaps = corridor_gaps({ego_in_the_middle(), {}}, kSettings);
  ASSERT_EQ(gaps.size(), 15u);
  for (const CorridorGaps& g : gaps) expect_gaps(g, 100.0, 0.0, 100.0, 0.0);
}

TEST(CorridorGapsOfTheRoad, MeasureBumperToBumperAheadAndBehind) {
  Scene scene{ego_in_the_middle(),
              {{.id = 1, .s_m = 130.0, .d_m = 4.8, .speed_mps = 7.0, .length_m = 8.0},
               {.id = 2, .s_m = 80.0, .d_m = 4.8, .speed_mps = 12.0}}};
  // 130 - 8 - 100 ahead; 100 - 5 - 80 behind.
  expect_gaps(corridor_gaps(scene, kSettings)[7], 22.0, -3.0, 15.0, -2.0);
}

// Swaths are 2.1 m wide. A vehicle 1.8 m wide reaches centres within 0.9 + 1.05 = 1.95 m: 2.85 to
// 6.75 around d = 4.8, of which corridors 4 (2.88) to 10 (6.72) have their centres there.
TEST(CorridorGapsOfTheRoad, AreClosedByAVehicleForTheWholeWidthOfTheSwath) {
  EXPECT_THAT(occupied({.s_m = 130.0, .d_m = 4.8}), testing::ElementsAre(4, 5, 6, 7, 8, 9, 10));
  // 0.04 m further left: 2.89 to 6.79.
  EXPECT_THAT(occupied({.s_m = 130.0, .d_m = 4.84}), testing::ElementsAre(5, 6, 7, 8, 9, 10));
}

TEST(CorridorGapsOfTheRoad, AreClosedInBothLanesByAVehicleOnTheLine) {
  // 1.25 to 5.15: corridors 2 (1.6) to 7 (4.8).
  EXPECT_THAT(occupied({.s_m = 130.0, .d_m = 3.2}), testing::ElementsAre(2, 3, 4, 5, 6, 7));
}

// Objects of 0.75 m at a hair's breadth from an edge of the middle lane, which is 3.2 m to 6.4 m.
constexpr Vehicle kAtTheRightEdge = {.s_m = 130.0, .d_m = 3.585, .length_m = 1.6, .width_m = 0.75};
constexpr Vehicle kAtTheLeftEdge = {.s_m = 130.0, .d_m = 6.015, .length_m = 1.6, .width_m = 0.75};

TEST(CorridorGapsOfTheRoad, LeaveACorridorOpenBesideAnObjectAtTheLanesEdge) {
  // Of corridors 6, 7 and 8, in which the ego stays within the lane, the furthest.
  EXPECT_THAT(occupied(kAtTheRightEdge), testing::ElementsAre(3, 4, 5, 6, 7));
  EXPECT_THAT(occupied(kAtTheLeftEdge), testing::ElementsAre(7, 8, 9, 10, 11));
}

TEST(CorridorGapsOfTheRoad, AreCutOffAtTheRoadsEdges) {
  EXPECT_THAT(occupied({.s_m = 130.0, .d_m = 0.9}), testing::ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(occupied({.s_m = 130.0, .d_m = 8.7}), testing::ElementsAre(11, 12, 13, 14));
  EXPECT_THAT(occupied({.s_m = 130.0, .d_m = -9.0}), testing::IsEmpty());
  EXPECT_THAT(occupied({.s_m = 130.0, .d_m = 19.0}), testing::IsEmpty());
}

TEST(CorridorGapsOfTheRoad, IncludeWhereLateralMotionLeadsWithinTheLookAhead) {
  EXPECT_THAT(occupied({.s_m = 130.0, .d_m = 8.0}), testing::ElementsAre(9, 10, 11, 12, 13, 14));
  // 0.7 m to the right in a second: from 6.05 down to 5.35, with corridor 8 (5.44).
  EXPECT_THAT(occupied({.s_m = 130.0, .d_m = 8.0, .lateral_speed_mps = -0.7}),
              testing::ElementsAre(8, 9, 10, 11, 12, 13, 14));
  // The other direction frees nothing.
  EXPECT_THAT(occupied({.s_m = 130.0, .d_m = 8.0, .lateral_speed_mps = 0.7}),
              testing::ElementsAre(9, 10, 11, 12, 13, 14));
}

TEST(CorridorGapsOfTheRoad, AreZeroOnBothSidesForAVehicleBeside) {
  for (const double s_m : {95.1, 100.0, 104.9}) {
    const auto gaps =
        corridor_gaps(scene_with({.s_m = s_m, .d_m = 8.0, .speed_mps = 12.0}), kSettings);
    expect_gaps(gaps[12], 0.0, 2.0, 0.0, -2.0);
    expect_gaps(gaps[7], 100.0, 0.0, 100.0, 0.0);
  }
}

TEST(CorridorGapsOfTheRoad, AreZeroOnOneSideForBumpersThatTouch) {
  const auto ahead =
      corridor_gaps(scene_with({.s_m = 105.0, .d_m = 4.8, .speed_mps = 9}), kSettings);
  expect_gaps(ahead[7], 0.0, -1.0, 100.0, 0.0);
  const auto behind =
      corridor_gaps(scene_with({.s_m = 95.0, .d_m = 4.8, .speed_mps = 9}), kSettings);
  expect_gaps(behind[7], 100.0, 0.0, 0.0, 1.0);
}

TEST(CorridorGapsOfTheRoad, IgnoreWhatIsOutOfRange) {
  EXPECT_THAT(occupied({.s_m = 205.0, .d_m = 4.8, .speed_mps = 3.0}), testing::IsEmpty());
  EXPECT_THAT(occupied({.s_m = 204.9, .d_m = 4.8, .speed_mps = 3.0}), testing::Contains(7));
  EXPECT_THAT(occupied({.s_m = -5.0, .d_m = 4.8, .speed_mps = 3.0}), testing::IsEmpty());
}

TEST(CorridorGapsOfTheRoad, TakeTheFasterClosingOfTwoEquallyNear) {
  Scene scene{ego_in_the_middle(),
              {{.id = 1, .s_m = 120.0, .d_m = 4.2, .speed_mps = 9.0},
               {.id = 2, .s_m = 120.0, .d_m = 5.4, .speed_mps = 4.0},
               {.id = 3, .s_m = 120.0, .d_m = 5.0, .speed_mps = 8.0}}};
  expect_gaps(corridor_gaps(scene, kSettings)[7], 15.0, -6.0, 100.0, 0.0);
}

// The definition, one corridor and one vehicle at a time.
TEST(CorridorGapsOfTheRoad, AgreeWithTheDefinitionInRandomScenes) {
  const Lanes lanes(kSettings);
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const Scene scene = random_scene(seed, kSettings);
    const auto gaps = corridor_gaps(scene, kSettings);
    for (int c = 0; c < lanes.corridors(); ++c) {
      double front_m = 100.0;
      double back_m = 100.0;
      for (const Vehicle& v : scene.others) {
        const double drift_m = v.lateral_speed_mps * 1.0;
        const double low_m = std::min(v.d_m, v.d_m + drift_m) - v.width_m / 2;
        const double high_m = std::max(v.d_m, v.d_m + drift_m) + v.width_m / 2;
        const double centre_m = lanes.corridor_centre_m(c);
        if (high_m <= centre_m - 1.05 || low_m >= centre_m + 1.05) continue;
        const double rear_m = v.s_m - v.length_m;
        if (v.s_m > 995.0) front_m = std::min(front_m, std::max(0.0, rear_m - 1000.0));
        if (rear_m < 1000.0) back_m = std::min(back_m, std::max(0.0, 995.0 - v.s_m));
      }
      const CorridorGaps& g = gaps[static_cast<std::size_t>(c)];
      ASSERT_NEAR(g.front_gap_m, front_m, 1e-9) << "scene " << seed << " corridor " << c;
      ASSERT_NEAR(g.back_gap_m, back_m, 1e-9) << "scene " << seed << " corridor " << c;
    }
  }
}

TEST(LaneGaps, SeeEveryBodyThatOverlapsTheLane) {
  // From 2.5 to 4.3: in lanes 0 and 1.
  const Scene scene = scene_with({.s_m = 125.0, .d_m = 3.4, .speed_mps = 6.0});
  expect_gaps(lane_gaps(scene, 0, kSettings), 20.0, -4.0, 100.0, 0.0);
  expect_gaps(lane_gaps(scene, 1, kSettings), 20.0, -4.0, 100.0, 0.0);
  expect_gaps(lane_gaps(scene, 2, kSettings), 100.0, 0.0, 100.0, 0.0);
}

TEST(LaneGaps, SeeAnObjectAtALanesEdgeInThatLaneOnly) {
  for (const Vehicle& object : {kAtTheRightEdge, kAtTheLeftEdge}) {
    for (int lane = 0; lane < 3; ++lane) {
      const CorridorGaps gaps = lane_gaps(scene_with(object), lane, kSettings);
      EXPECT_NEAR(gaps.front_gap_m, lane == 1 ? 28.4 : 100.0, 1e-9) << lane;
    }
  }
}

TEST(LaneGaps, DoNotLookAhead) {
  const Scene scene = scene_with({.s_m = 125.0, .d_m = 7.4, .lateral_speed_mps = -2.0});
  expect_gaps(lane_gaps(scene, 1, kSettings), 100.0, 0.0, 100.0, 0.0);
}

TEST(LaneGaps, AreZeroInALaneThatDoesNotExist) {
  expect_gaps(lane_gaps({ego_in_the_middle(), {}}, -1, kSettings), 0.0, 0.0, 0.0, 0.0);
  expect_gaps(lane_gaps({ego_in_the_middle(), {}}, 3, kSettings), 0.0, 0.0, 0.0, 0.0);
}

}  // namespace
}  // namespace corridor::driving
