#include "actor/driving/rules_bp.h"

#include <gtest/gtest.h>

#include "actor/driving/skills.h"
#include "tests/actor/driving/scenes.h"

namespace corridor::driving {
namespace {

// The ego in the middle lane at 12 m/s behind a leader at 7 m/s.
constexpr double kLaneCentre_m[] = {1.6, 4.8, 8.0};

Vehicle slow_leader() { return {.id = 1, .s_m = 135.0, .d_m = 4.8, .speed_mps = 7.0}; }

Command decide(RuleBasedBp& bp, const Ego& ego, std::vector<Vehicle> others) {
  return bp.decide(situation_of({ego, std::move(others)}, kSettings));
}

TEST(RuleBasedBp, KeepsALaneWithoutASlowLeader) {
  RuleBasedBp bp(kSettings);
  EXPECT_EQ(decide(bp, ego_at(1.6, 12.0), {}), Command::kKeep);
  EXPECT_EQ(decide(bp, ego_at(1.6, 12.0), {{.id = 1, .s_m = 135.0, .d_m = 1.6, .speed_mps = 13.5}}),
            Command::kKeep);
}

TEST(RuleBasedBp, PassesASlowLeaderOnTheLeft) {
  RuleBasedBp bp(kSettings);
  EXPECT_EQ(decide(bp, ego_at(4.8, 12.0), {slow_leader()}), Command::kLeft);
}

TEST(RuleBasedBp, PassesOnTheRightWhereTheLeftIsSlowToo) {
  RuleBasedBp bp(kSettings);
  const Vehicle left{.id = 2, .s_m = 135.0, .d_m = 8.0, .speed_mps = 7.2};
  EXPECT_EQ(decide(bp, ego_at(4.8, 12.0), {slow_leader(), left}), Command::kRight);
}

TEST(RuleBasedBp, StaysBehindASlowLeaderWhereNoLaneIsFaster) {
  RuleBasedBp bp(kSettings);
  const Vehicle left{.id = 2, .s_m = 135.0, .d_m = 8.0, .speed_mps = 7.2};
  const Vehicle right{.id = 3, .s_m = 135.0, .d_m = 1.6, .speed_mps = 6.0};
  EXPECT_EQ(decide(bp, ego_at(4.8, 12.0), {slow_leader(), left, right}), Command::kKeep);
}

TEST(RuleBasedBp, DoesNotChangeWithoutRoom) {
  for (const double s_m : {108.0, 100.0, 92.0}) {  // ahead, beside, behind
    RuleBasedBp bp(kSettings);
    const Vehicle left{.id = 2, .s_m = s_m, .d_m = 8.0, .speed_mps = 13.0};
    const Vehicle right{.id = 3, .s_m = s_m, .d_m = 1.6, .speed_mps = 13.0};
    EXPECT_EQ(decide(bp, ego_at(4.8, 12.0), {slow_leader(), left, right}), Command::kKeep) << s_m;
  }
}

TEST(RuleBasedBp, MindsHowFastAFollowerClosesIn) {
  Vehicle follower{.id = 2, .s_m = 79.0, .d_m = 8.0, .speed_mps = 12.0};  // 16 m behind
  const Vehicle right{.id = 3, .s_m = 100.0, .d_m = 1.6, .speed_mps = 12.0};
  RuleBasedBp first(kSettings);
  EXPECT_EQ(decide(first, ego_at(4.8, 12.0), {slow_leader(), follower, right}), Command::kLeft);
  follower.speed_mps = 22.0;
  RuleBasedBp second(kSettings);
  EXPECT_EQ(decide(second, ego_at(4.8, 12.0), {slow_leader(), follower, right}), Command::kKeep);
}

TEST(RuleBasedBp, KeepsAskingUntilTheEgosCentreIsInTheGoalLane) {
  RuleBasedBp bp(kSettings);
  const Lanes lanes(kSettings);
  for (int corridor = 7; corridor <= 9; ++corridor) {
    // The leader speeds up: the change goes on all the same.
    Vehicle leader = slow_leader();
    if (corridor > 7) leader.speed_mps = 13.0;
    EXPECT_EQ(decide(bp, ego_at(lanes.corridor_centre_m(corridor), 12.0), {leader}),
              Command::kLeft);
  }
  EXPECT_EQ(decide(bp, ego_at(lanes.corridor_centre_m(10), 12.0), {slow_leader()}), Command::kKeep);
}

TEST(RuleBasedBp, CancelsAChangeWhoseRoomIsGone) {
  RuleBasedBp bp(kSettings);
  ASSERT_EQ(decide(bp, ego_at(4.8, 12.0), {slow_leader()}), Command::kLeft);
  const double d_m = Lanes(kSettings).corridor_centre_m(8);
  const Vehicle beside{.id = 2, .s_m = 101.0, .d_m = 8.0, .speed_mps = 12.0};
  const Vehicle right{.id = 3, .s_m = 101.0, .d_m = 1.6, .speed_mps = 12.0};
  EXPECT_EQ(decide(bp, ego_at(d_m, 12.0), {slow_leader(), beside, right}), Command::kKeep);
}

TEST(RuleBasedBp, ReturnsToTheRightWhenItIsFree) {
  RuleBasedBp bp(kSettings);
  EXPECT_EQ(decide(bp, ego_at(8.0, 13.0), {}), Command::kRight);
}

TEST(RuleBasedBp, DoesNotReturnBehindASlowVehicle) {
  RuleBasedBp bp(kSettings);
  EXPECT_EQ(decide(bp, ego_at(8.0, 13.0), {slow_leader()}), Command::kKeep);
}

TEST(RuleBasedBp, ForgetsItsGoalWithTheEpisode) {
  RuleBasedBp bp(kSettings);
  ASSERT_EQ(decide(bp, ego_at(4.8, 12.0), {slow_leader()}), Command::kLeft);
  bp.begin_episode(1);
  EXPECT_EQ(decide(bp, ego_at(1.6, 12.0), {}), Command::kKeep);
}

TEST(RuleBasedBp, NeverAsksForALaneThatDoesNotExist) {
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    RuleBasedBp bp(kSettings);
    const Scene scene = random_scene(seed, kSettings);
    const Command command = bp.decide(situation_of(scene, kSettings));
    ASSERT_EQ(command, feasible(command, scene.ego, kSettings));
  }
}

}  // namespace
}  // namespace corridor::driving
