// SPDX-License-Identifier: Apache-2.0
#include "actor/driving/collision.h"

#include <gtest/gtest.h>

#include "tests/actor/driving/scenes.h"

namespace corridor::driving {
namespace {

const EgoSettings kEgo;  // 5.0 m x 1.8 m

// The ego keeps its place unless it is moved; one other vehicle goes from one place to another.
std::optional<Collision> collide(const Vehicle& from, const Vehicle& to, double ego_from_d_m = 4.8,
                                 double ego_to_d_m = 4.8) {
  Scene before{ego_in_the_middle(), {from}};
  before.ego.d_m = ego_from_d_m;
  Scene after{ego_in_the_middle(), {to}};
  after.ego.d_m = ego_to_d_m;
  return find_collision(before, after, kEgo);
}

TEST(FindCollision, SeesNoneBetweenVehiclesThatTouch) {
  EXPECT_FALSE(collide({.s_m = 105.0, .d_m = 4.8}, {.s_m = 105.0, .d_m = 4.8}));
  EXPECT_FALSE(collide({.s_m = 95.0, .d_m = 4.8}, {.s_m = 95.0, .d_m = 4.8}));
  const double beside_m = ego_in_the_middle().d_m + 1.8 + 1e-9;
  EXPECT_FALSE(collide({.s_m = 100.0, .d_m = beside_m}, {.s_m = 100.0, .d_m = beside_m}));
}

TEST(FindCollision, SeesAnObjectAtTheLanesEdgeFromTheMiddleAndNotFromTheNextCorridor) {
  const Vehicle object = {.id = 4, .s_m = 108.0, .d_m = 3.585, .length_m = 9.0, .width_m = 0.75};
  EXPECT_EQ(collide(object, object), (Collision{CollisionKind::kRearEnding, 4}));
  EXPECT_FALSE(collide(object, object, 5.44, 5.44));
}

TEST(FindCollision, SeesRearEndings) {
  const auto hit =
      collide({.id = 4, .s_m = 106.0, .d_m = 5.5}, {.id = 4, .s_m = 104.0, .d_m = 5.5});
  EXPECT_EQ(hit, (Collision{CollisionKind::kRearEnding, 4}));
}

TEST(FindCollision, SeesTheEgoRearEnded) {
  const auto hit = collide({.id = 4, .s_m = 90.0, .d_m = 4.0}, {.id = 4, .s_m = 97.0, .d_m = 4.0});
  EXPECT_EQ(hit, (Collision{CollisionKind::kRearEnded, 4}));
}

TEST(FindCollision, BlamesWhoeverWasBehindInAFastApproach) {
  // 12 m in one step: the front bumper is past the ego's when the overlap is seen.
  const auto hit = collide({.id = 4, .s_m = 92.0, .d_m = 4.8}, {.id = 4, .s_m = 104.0, .d_m = 4.8});
  EXPECT_EQ(hit, (Collision{CollisionKind::kRearEnded, 4}));
}

TEST(FindCollision, BlamesTheOtherThatMovedSideways) {
  const auto left =
      collide({.id = 4, .s_m = 101.0, .d_m = 7.0}, {.id = 4, .s_m = 101.0, .d_m = 6.0});
  EXPECT_EQ(left, (Collision{CollisionKind::kSideByOther, 4}));
  const auto right =
      collide({.id = 4, .s_m = 101.0, .d_m = 2.6}, {.id = 4, .s_m = 101.0, .d_m = 3.4});
  EXPECT_EQ(right, (Collision{CollisionKind::kSideByOther, 4}));
}

TEST(FindCollision, BlamesTheEgoThatMovedSideways) {
  const Vehicle beside{.id = 4, .s_m = 103.0, .d_m = 6.9};
  EXPECT_EQ(collide(beside, beside, 4.8, 5.44), (Collision{CollisionKind::kSideByEgo, 4}));
  const Vehicle right{.id = 4, .s_m = 103.0, .d_m = 2.7};
  EXPECT_EQ(collide(right, right, 4.8, 4.16), (Collision{CollisionKind::kSideByEgo, 4}));
}

TEST(FindCollision, BlamesWhoeverMovedFurtherWhereBothDid) {
  const Vehicle from{.id = 4, .s_m = 103.0, .d_m = 7.0};
  EXPECT_EQ(collide(from, {.id = 4, .s_m = 103.0, .d_m = 6.6}, 4.8, 5.44)->kind,
            CollisionKind::kSideByEgo);
  EXPECT_EQ(collide(from, {.id = 4, .s_m = 103.0, .d_m = 6.0}, 4.8, 5.44)->kind,
            CollisionKind::kSideByOther);
}

TEST(FindCollision, BlamesTheEgoThatRanIntoTheSideOfAFleeingVehicle) {
  const auto hit =
      collide({.id = 4, .s_m = 103.0, .d_m = 6.7}, {.id = 4, .s_m = 103.0, .d_m = 6.8}, 4.8, 5.44);
  EXPECT_EQ(hit->kind, CollisionKind::kSideByEgo);
}

std::optional<Collision> collide_with_newcomer(const Vehicle& newcomer, double ego_lateral_mps) {
  const Scene before{ego_in_the_middle(), {}};
  Scene after{ego_in_the_middle(), {newcomer}};
  after.ego.lateral_speed_mps = ego_lateral_mps;
  return find_collision(before, after, kEgo);
}

TEST(FindCollision, JudgesANewcomerByTheLateralSpeeds) {
  Vehicle newcomer{.id = 9, .s_m = 103.0, .d_m = 6.0, .lateral_speed_mps = -0.8};
  EXPECT_EQ(collide_with_newcomer(newcomer, 0.0)->kind, CollisionKind::kSideByOther);
  EXPECT_EQ(collide_with_newcomer(newcomer, 0.9)->kind, CollisionKind::kSideByEgo);
  newcomer.lateral_speed_mps = 0.8;  // away
  EXPECT_EQ(collide_with_newcomer(newcomer, 0.0)->kind, CollisionKind::kRearEnding);
  newcomer.lateral_speed_mps = 0.0;
  EXPECT_EQ(collide_with_newcomer(newcomer, 0.0)->kind, CollisionKind::kRearEnding);
  newcomer.s_m = 97.0;
  EXPECT_EQ(collide_with_newcomer(newcomer, -0.1)->kind, CollisionKind::kRearEnded);
}

TEST(FindCollision, FindsTheEarlierPlaceOfAVehicleAmongMany) {
  const Scene before{ego_in_the_middle(),
                     {{.id = 2, .s_m = 300.0, .d_m = 1.6},
                      {.id = 5, .s_m = 100.0, .d_m = 8.0},
                      {.id = 7, .s_m = 106.0, .d_m = 4.8}}};
  const Scene after{ego_in_the_middle(),
                    {{.id = 1, .s_m = 200.0, .d_m = 4.8},
                     {.id = 5, .s_m = 100.0, .d_m = 6.5},
                     {.id = 7, .s_m = 104.0, .d_m = 4.8}}};
  EXPECT_EQ(find_collision(before, after, kEgo), (Collision{CollisionKind::kSideByOther, 5}));
}

TEST(FindCollision, UsesTheLengthsAndWidthsOfBoth) {
  const Vehicle truck{.id = 1, .s_m = 111.0, .d_m = 6.9, .length_m = 12.0, .width_m = 2.5};
  EXPECT_TRUE(collide(truck, truck));
  Vehicle car = truck;
  car.length_m = 5.0;
  EXPECT_FALSE(collide(car, car));
  car = truck;
  car.width_m = 1.8;
  EXPECT_FALSE(collide(car, car));
}

TEST(CollisionKinds, HaveTheNamesOfTheRecords) {
  EXPECT_STREQ(name_of(CollisionKind::kRearEnded), "rear_ended");
  EXPECT_STREQ(name_of(CollisionKind::kRearEnding), "rear_ending");
  EXPECT_STREQ(name_of(CollisionKind::kSideByOther), "side_by_other");
  EXPECT_STREQ(name_of(CollisionKind::kSideByEgo), "side_by_ego");
  EXPECT_STREQ(name_of(CollisionKind::kOffRoad), "off_road");
}

// The ego with a yaw, against another one beside it.
bool touches(double yaw_rad, const Vehicle& other) {
  Scene scene{ego_in_the_middle(), {other}};
  scene.ego.yaw_rad = yaw_rad;
  return find_collision(scene, scene, kEgo).has_value();
}

TEST(FindCollision, TurnsTheEgosBodyByItsYaw) {
  const Ego ego = ego_in_the_middle();
  // Beside its rear, 5 cm away: to turn left about the front bumper swings the rear to the right.
  const Vehicle right{.id = 4, .s_m = ego.s_m - 2.0, .d_m = ego.d_m - 1.85};
  const Vehicle left{.id = 4, .s_m = ego.s_m - 2.0, .d_m = ego.d_m + 1.85};
  for (const double yaw_rad : {0.0, 1e-12}) {
    EXPECT_FALSE(touches(yaw_rad, right));
    EXPECT_FALSE(touches(yaw_rad, left));
  }
  EXPECT_TRUE(touches(0.05, right));
  EXPECT_FALSE(touches(-0.05, right));
  EXPECT_TRUE(touches(-0.05, left));
  EXPECT_FALSE(touches(0.05, left));
}

TEST(FindCollision, SeesAcrossACorner) {
  const Ego ego = ego_in_the_middle();
  // Boxes along the road around both would overlap; the turned one passes by the corner.
  const Vehicle corner{.id = 4, .s_m = ego.s_m + 5.5, .d_m = ego.d_m - 1.7};
  EXPECT_FALSE(touches(0.4, corner));
  EXPECT_TRUE(touches(-0.4, {.id = 4, .s_m = ego.s_m + 5.3, .d_m = ego.d_m}));
}

}  // namespace
}  // namespace corridor::driving
