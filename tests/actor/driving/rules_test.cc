// SPDX-License-Identifier: Apache-2.0
#include "actor/driving/rules.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "actor/driving/collision.h"
#include "actor/driving/skills.h"
#include "actor/driving/trajectory.h"
#include "proto/base/failure.h"
#include "tests/actor/driving/scenes.h"

namespace corridor::driving {
namespace {

TEST(Following, BrakesAndClosesInOverTheSquareOfTheSpeed) {
  EXPECT_EQ(braking_way_m(6.0, 3.0), 6.0);
  EXPECT_EQ(closing_way_m(-6.0, 3.0), 6.0);
  EXPECT_EQ(closing_way_m(2.0, 3.0), 0.0) << "it draws away";
}

TEST(Following, KeepsTheDistanceThatTheRewardAsksFor) {
  EXPECT_EQ(headway_m(10.0, kSettings),
            10.0 * kSettings.mop_reward.headway_s + kSettings.mop_reward.standstill_gap_m);
}

TEST(Following, IsPromisedTheLimitOnAFreeRoadAndTheLeadersSpeedCloseBehindIt) {
  const Ego ego = ego_in_the_middle();
  const double limit_mps = kSettings.road.speed_limit_mps;
  EXPECT_EQ(promise_mps({.front_gap_m = 100.0}, ego, kSettings), limit_mps);
  EXPECT_EQ(promise_mps({.front_gap_m = 5.0, .front_rate_mps = -3.0}, ego, kSettings), 7.0);
  const double further = promise_mps({.front_gap_m = 40.0, .front_rate_mps = -3.0}, ego, kSettings);
  EXPECT_GT(further, 7.0);
  EXPECT_LT(further, limit_mps);
}

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

// The ego after one step of the MoP's action, as the world does it.
Ego advance(const Ego& ego, int action, const DrivingSettings& settings) {
  const Trajectory trajectory(ego, target_for(mop_action(action), ego, settings), settings);
  const TrajectoryPoint end = trajectory.at(settings.step_s);
  return {.s_m = end.s_m,
          .d_m = end.d_m,
          .speed_mps = end.speed_mps,
          .acceleration_mps2 = (end.speed_mps - ego.speed_mps) / settings.step_s,
          .lateral_speed_mps = end.lateral_speed_mps,
          .set_point_mps = trajectory.target().set_point_mps};
}

MopAction decide(const Scene& scene, Command command) {
  RuleBasedMop mop(kSettings);
  return mop_action(
      mop.decide(situation_of(scene, kSettings), window_for(command, scene.ego, kSettings)));
}

TEST(RuleBasedMop, DrivesAtTheSpeedLimitInTheMiddleOfAnEmptyRoad) {
  RuleBasedMop mop(kSettings);
  Ego ego = ego_at(3.52, 0.0);  // corridor 5, which is closed
  for (int step = 0; step < 10; ++step) {
    const Situation situation = situation_of({ego, {}}, kSettings);
    ego =
        advance(ego, mop.decide(situation, window_for(Command::kKeep, ego, kSettings)), kSettings);
  }
  EXPECT_EQ(ego.speed_mps, 13.89);
  EXPECT_EQ(ego.d_m, Lanes(kSettings).corridor_centre_m(7));
}

TEST(RuleBasedMop, MovesTowardsTheWindowsMiddle) {
  const Scene scene{ego_in_the_middle(), {}};
  EXPECT_EQ(decide(scene, Command::kKeep).corridor_change, 0);
  EXPECT_EQ(decide(scene, Command::kLeft).corridor_change, 1);
  EXPECT_EQ(decide(scene, Command::kRight).corridor_change, -1);
}

TEST(RuleBasedMop, StaysWhereAVehicleIsBesideTheWayToTheMiddle) {
  // From 5.95 m: in the swath of corridor 8, not in the ego's.
  const Scene scene{ego_in_the_middle(), {{.id = 1, .s_m = 101.0, .d_m = 6.85, .speed_mps = 10.0}}};
  EXPECT_EQ(decide(scene, Command::kLeft).corridor_change, 0);
  EXPECT_EQ(decide(scene, Command::kRight).corridor_change, -1);
}

TEST(RuleBasedMop, DoesNotMoveInFrontOfAFastFollower) {
  Vehicle follower{.id = 1, .s_m = 82.0, .d_m = 8.0, .speed_mps = 10.0};
  Ego ego = ego_at(Lanes(kSettings).corridor_centre_m(8), 10.0);
  EXPECT_EQ(decide({ego, {follower}}, Command::kLeft).corridor_change, 1);
  follower.speed_mps = 18.0;  // 13 m behind, 8 m/s faster
  EXPECT_EQ(decide({ego, {follower}}, Command::kLeft).corridor_change, 0);
}

TEST(RuleBasedMop, MovesWithinTheLaneBehindALeaderThatFillsIt) {
  const Scene scene{ego_at(Lanes(kSettings).corridor_centre_m(6), 5.0),
                    {{.id = 1, .s_m = 108.0, .d_m = 4.8, .speed_mps = 5.0}}};
  EXPECT_EQ(decide(scene, Command::kKeep).corridor_change, 1);
}

TEST(RuleBasedMop, GivesWayToAVehicleThatMovesOverFromTheSide) {
  const Scene scene{
      ego_in_the_middle(),
      {{.id = 1, .s_m = 101.0, .d_m = 7.2, .speed_mps = 10.0, .lateral_speed_mps = -1.0}}};
  const MopAction action = decide(scene, Command::kKeep);
  EXPECT_EQ(action.corridor_change, -1);
  EXPECT_EQ(action.speed_change, 0);
}

TEST(RuleBasedMop, ComesBackFromACorridorThatClosedWithACancelledChange) {
  for (const int corridor : {5, 9}) {
    const Scene scene{ego_at(Lanes(kSettings).corridor_centre_m(corridor), 10.0), {}};
    EXPECT_EQ(decide(scene, Command::kKeep).corridor_change, corridor == 5 ? 1 : -1);
  }
}

// Stopped at the right edge of the ego's lane, its near end 60 m ahead.
TEST(RuleBasedMop, GoesAroundAnObjectAtTheLanesEdgeAndBackToTheMiddle) {
  const Vehicle object{.id = 1, .s_m = 169.0, .d_m = 3.585, .length_m = 9.0, .width_m = 0.75};
  RuleBasedMop mop(kSettings);
  Ego ego = ego_in_the_middle();
  double most_left_m = 0.0;
  for (int step = 0; step < 15; ++step) {
    const Situation situation = situation_of({ego, {object}}, kSettings);
    ego =
        advance(ego, mop.decide(situation, window_for(Command::kKeep, ego, kSettings)), kSettings);
    const bool beside = ego.s_m > 160.0 && ego.s_m < 169.0 + kSettings.ego.length_m;
    EXPECT_FALSE(beside && overlap_across(ego, object, kSettings.ego)) << step;
    EXPECT_GT(ego.speed_mps, 5.0);
    most_left_m = std::max(most_left_m, ego.d_m);
  }
  EXPECT_GT(ego.s_m, 169.0 + kSettings.ego.length_m);
  EXPECT_NEAR(most_left_m, 5.44, 1e-9);
  EXPECT_NEAR(ego.d_m, 4.8, 1e-9);
}

TEST(RuleBasedMop, ChoosesOpenCorridorsOnlyInRandomScenes) {
  const Lanes lanes(kSettings);
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    Scene scene = random_scene(seed, kSettings);
    scene.ego.d_m = lanes.corridor_centre_m(1 + static_cast<int>(seed % 13));
    for (const Command asked : {Command::kKeep, Command::kLeft, Command::kRight}) {
      const Command command = feasible(asked, scene.ego, kSettings);
      const Window window = window_for(command, scene.ego, kSettings);
      const int corridor = lanes.corridor_at(scene.ego.d_m);
      const int entered = corridor + decide(scene, command).corridor_change;
      ASSERT_TRUE(entered == corridor || window.is_open(entered) || !window.is_open(corridor));
    }
  }
}

TEST(RuleBasedMop, RefusesActionsThatCannotBrake) {
  DrivingSettings settings = kSettings;
  settings.planner.speed_changes_mps = {0.0, 2.0};
  EXPECT_THROW(RuleBasedMop mop(settings), Failure);
}

// One leader in one lane: the least gap, and the ego at the end.
struct Following {
  double least_gap_m = 1e9;
  double gap_m = 0.0;
  Ego ego;
};

template <typename LeaderSpeed>
Following follow(Ego ego, double gap_m, int steps, const DrivingSettings& settings,
                 LeaderSpeed leader_speed_mps) {
  RuleBasedMop mop(settings);
  Vehicle leader{.id = 1, .s_m = ego.s_m + gap_m + 5.0, .d_m = ego.d_m};
  leader.speed_mps = leader_speed_mps(0.0);
  Following result;
  for (int step = 1; step <= steps; ++step) {
    const Situation situation = situation_of({ego, {leader}}, settings);
    const Window window = window_for(Command::kKeep, ego, settings);
    ego = advance(ego, mop.decide(situation, window), settings);
    const double speed_mps = leader_speed_mps(step * settings.step_s);
    leader.s_m += (leader.speed_mps + speed_mps) / 2 * settings.step_s;
    leader.speed_mps = speed_mps;
    result.gap_m = leader.s_m - 5.0 - ego.s_m;
    result.least_gap_m = std::min(result.least_gap_m, result.gap_m);
  }
  result.ego = ego;
  return result;
}

TEST(RuleBasedMopFollowing, ClosesUpAndKeepsItsDistanceAtEverySpeed) {
  for (const double step_s : {1.0, 0.5}) {
    DrivingSettings settings = kSettings;
    settings.step_s = step_s;
    for (double leader_mps = 0.0; leader_mps < 13.5; leader_mps += 0.7) {
      const Following end =
          follow(ego_at(4.8, 13.89), 90.0, 300, settings, [&](double) { return leader_mps; });
      EXPECT_GE(end.least_gap_m, 1.0) << leader_mps;
      EXPECT_LT(end.gap_m, 2.5 * (1.2 * leader_mps + 3.0) + 6.0) << leader_mps;
    }
  }
}

TEST(RuleBasedMopFollowing, NeverHitsALeaderThatBrakesHardAtAnyMoment) {
  for (const double step_s : {1.0, 0.5}) {
    DrivingSettings settings = kSettings;
    settings.step_s = step_s;
    for (double leader_mps = 2.0; leader_mps < 14.0; leader_mps += 1.0) {
      for (int brakes_at = 0; brakes_at < 40; ++brakes_at) {
        const auto speed = [&](double t_s) {
          return std::max(0.0, leader_mps - 4.0 * std::max(0.0, t_s - brakes_at * step_s));
        };
        const Following end = follow(ego_at(4.8, 13.89), 60.0, 80, settings, speed);
        ASSERT_GT(end.least_gap_m, 0.0) << leader_mps << " m/s, brakes at step " << brakes_at;
        ASSERT_EQ(end.ego.speed_mps, 0.0);
      }
    }
  }
}

TEST(RuleBasedMopFollowing, StartsAgainWithItsLeader) {
  const Following end = follow(ego_at(4.8, 0.0), 3.0, 60, kSettings,
                               [](double t_s) { return std::clamp(t_s - 10.0, 0.0, 12.0); });
  EXPECT_GT(end.least_gap_m, 1.0);
  EXPECT_GT(end.ego.speed_mps, 7.0);
}

}  // namespace
}  // namespace corridor::driving
