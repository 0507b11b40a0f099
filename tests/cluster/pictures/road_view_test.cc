// SPDX-License-Identifier: Apache-2.0
#include "cluster/pictures/road_view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/driven.h"

namespace corridor::cluster {
namespace {

using testing::Contains;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::FieldsAre;
using testing_support::areas;
using testing_support::drawn;
using testing_support::driven_episode;
using testing_support::texts;

// Ten pixels a metre: the ego's front is at x = 300, the road's right edge at y = 98.
constexpr RoadView kView{.width = 1000.0, .behind_m = 30.0, .ahead_m = 70.0};

Clip clip(std::size_t steps) {
  return clip_of(driven_episode(steps), "", 0.0, static_cast<double>(steps));
}

struct Box {
  double left, top, right, bottom;
};
Box box_of(const Area& area) {
  Box box{1e9, 1e9, -1e9, -1e9};
  for (const auto& [x, y] : area.corners) {
    box = {std::min(box.left, x), std::min(box.top, y), std::max(box.right, x),
           std::max(box.bottom, y)};
  }
  return box;
}

auto is_box(double left, double top, double right, double bottom) {
  return FieldsAre(DoubleNear(left, 1e-9), DoubleNear(top, 1e-9), DoubleNear(right, 1e-9),
                   DoubleNear(bottom, 1e-9));
}

TEST(RoadView, IsAsHighAsTheRoadWithItsEdgeLines) {
  const Canvas canvas = road_from_above(clip(2), 0.0, kView);
  EXPECT_DOUBLE_EQ(canvas.height, 100.0);
  EXPECT_DOUBLE_EQ(canvas.width, 1000.0);
}

TEST(RoadView, PutsVehiclesBehindTheirFrontBumpersWithTheirSpeeds) {
  const Canvas canvas = road_from_above(clip(4), 2.0, kView);
  const auto egos = areas(canvas, kEgo), others = areas(canvas, kOther);
  ASSERT_EQ(egos.size(), 1u);
  EXPECT_THAT(box_of(egos[0]), is_box(250, 41, 300, 59));
  ASSERT_EQ(others.size(), 2u);
  EXPECT_THAT(box_of(others[0]), is_box(450, 73, 500, 91)) << "20 m ahead in the right lane";
  EXPECT_THAT(box_of(others[1]), is_box(650, 9, 700, 27)) << "at 60 m in the left lane";
  EXPECT_THAT(texts(canvas), ElementsAre("45", "0", "36"));
}

TEST(RoadView, TurnsAVehicleToTheLeftAboutItsFrontBumper) {
  Clip turned = clip(2);
  turned.trace.steps[0].ego.yaw_rad = 0.1;
  const Canvas canvas = road_from_above(turned, 0.0, kView);
  const Area ego = areas(canvas, kEgo).at(0);
  const Point rear = ego.corners.back(), other_rear = ego.corners[ego.corners.size() - 2];
  EXPECT_NEAR((rear.x + other_rear.x) / 2, 300.0 - 50.0 * std::cos(0.1), 1e-9);
  EXPECT_NEAR((rear.y + other_rear.y) / 2, 50.0 + 50.0 * std::sin(0.1), 1e-9);
  EXPECT_EQ(drawn<Text>(canvas.shapes).back().turn_rad, 0.1);
}

TEST(RoadView, LeavesOutWhoIsOutOfIt) {
  Clip far = clip(1);
  far.trace.steps[0].others = {{8, 80.0, 1.6, 10.0, 5.0, 1.8, 0.0},
                               {9, -40.0, 1.6, 10.0, 5.0, 1.8, 0.0},
                               {10, 74.0, 1.6, 10.0, 5.0, 1.8, 0.0}};
  EXPECT_EQ(areas(road_from_above(far, 0.0, kView), kOther).size(), 1u) << "who shows in part";
}

TEST(RoadView, ShowsOpenCorridorsAsFarAsTheyAreFreeAndTheTrajectory) {
  const Canvas canvas = road_from_above(clip(2), 0.0, kView);
  EXPECT_EQ(areas(canvas, kOpen).size(), 2u);
  const auto chosen = areas(canvas, kChosen);
  ASSERT_EQ(chosen.size(), 1u);
  // Corridor 8 of 15 is from 5.12 to 5.76 m; a pixel on each side is left free.
  EXPECT_THAT(box_of(chosen[0]), is_box(50, 41.4, 700, 45.8));
  const auto lines = drawn<Line>(canvas.shapes);
  EXPECT_THAT(lines, Contains(testing::Field(&Line::points,
                                             ElementsAre(FieldsAre(300, DoubleNear(50, 1e-9)),
                                                         FieldsAre(400, DoubleNear(46, 1e-9)),
                                                         FieldsAre(500, DoubleNear(44, 1e-9))))));
  Clip undecided = clip(2);
  undecided.trace.steps[0].decision.reset();
  EXPECT_TRUE(areas(road_from_above(undecided, 0.0, kView), kOpen).empty());
}

TEST(RoadView, LeavesOutCorridorsBesideTheRoad) {
  Clip beside = clip(2);
  beside.trace.steps[0].decision->window_first = -3;
  EXPECT_EQ(areas(road_from_above(beside, 0.0, kView), kOpen).size(), 1u);
  beside.trace.steps[0].decision->window_first = 13;
  EXPECT_EQ(areas(road_from_above(beside, 0.0, kView), kOpen).size(), 1u);
}

TEST(RoadView, MarksBetweenLanesStandStillOnTheRoad) {
  const auto marks = [](double time_s) {
    std::vector<double> at;
    for (const Line& line : drawn<Line>(road_from_above(clip(4), time_s, kView).shapes)) {
      if (line.width == 2.0) at.push_back(line.points[0].x + 100.0 * time_s);
    }
    return at;
  };
  EXPECT_THAT(marks(1.0), Contains(DoubleNear(marks(0.0).at(3), 1e-9)));
}

TEST(RoadView, WhoIsHitStandsOutAtTheCollisionOrBefore) {
  const Clip driven = clip(4);
  RoadView view = kView;
  EXPECT_TRUE(areas(road_from_above(driven, 2.0, view), kHit).empty());
  EXPECT_EQ(areas(road_from_above(driven, 3.0, view), kHit).size(), 1u);
  view.hit_stands_out_before = true;
  EXPECT_EQ(areas(road_from_above(driven, 2.0, view), kHit).size(), 1u);
  const Clip before = clip_of(driven_episode(4), "", 0.0, 2.0);
  EXPECT_TRUE(areas(road_from_above(before, 2.0, view), kHit).empty()) << "there is none in it";
}

}  // namespace
}  // namespace corridor::cluster
