// SPDX-License-Identifier: Apache-2.0
#include "actor/driving/shield.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "actor/driving/skills.h"
#include "tests/actor/driving/scenes.h"

namespace corridor::driving {
namespace {

// In the defaults' [-4, -2, -1, 0, 1, 2] m/s.
constexpr int kBrakeHard = 0;
constexpr int kHold = 3;
constexpr int kAccelerate = 5;

Scene with(Vehicle other) { return {ego_in_the_middle(), {std::move(other)}}; }

// 5 m long, in the middle of the ego's lane; `gap_m` from bumper to bumper.
Vehicle leader(double gap_m, double speed_mps) {
  return {.id = 1, .s_m = 105.0 + gap_m, .d_m = 4.8, .speed_mps = speed_mps};
}

MopAction shielded_in(const Scene& scene, const MopAction& action) {
  return shielded(action, scene, kSettings);
}

std::vector<MopAction> all_actions() {
  std::vector<MopAction> actions;
  for (const int corridor_change : {-1, 0, 1}) {
    for (int speed_change = 0; speed_change <= kAccelerate; ++speed_change)
      actions.push_back({corridor_change, speed_change});
  }
  return actions;
}

TEST(Shield, LetsEveryActionPassOnAnEmptyRoad) {
  for (const MopAction& action : all_actions())
    EXPECT_EQ(shielded_in({ego_in_the_middle(), {}}, action), action);
}

TEST(Shield, LetsPassWhatIsSafe) {
  EXPECT_EQ(shielded_in(with(leader(60.0, 10.0)), {0, kAccelerate}), (MopAction{0, kAccelerate}));
}

// From 10 m/s the ego stands after 3 steps and 7.33 + 3.33 + 0.33 m.
TEST(Shield, BrakesForAStoppedVehicleWhileThatStillHelps) {
  EXPECT_EQ(shielded_in(with(leader(11.5, 0.0)), {0, kBrakeHard}), (MopAction{0, kBrakeHard}));
  EXPECT_EQ(shielded_in(with(leader(11.5, 0.0)), {0, kAccelerate}).speed_change, kBrakeHard);
}

TEST(Shield, TakesTheSpeedNearestToThePlannedOneThatIsSafe) {
  const MopAction action = shielded_in(with(leader(17.0, 0.0)), {0, kAccelerate});
  EXPECT_EQ(action.corridor_change, 0);
  EXPECT_GT(action.speed_change, kBrakeHard);
  EXPECT_LT(action.speed_change, kAccelerate);
}

// Going on at the leader's speed is safe as long as it does; but it may brake.
TEST(Shield, ReckonsWithALeaderThatBrakes) {
  EXPECT_EQ(shielded_in(with(leader(25.0, 10.0)), {0, kHold}), (MopAction{0, kHold}));
  EXPECT_LT(shielded_in(with(leader(1.0, 10.0)), {0, kHold}).speed_change, kHold);
}

// Vehicle 1 moves over from the left, to in front of the ego.
TEST(Shield, ExpectsWhoCutsInTooCloseBehindAnotherToStopAtOnce) {
  Scene scene =
      with({.id = 1, .s_m = 114.0, .d_m = 7.0, .speed_mps = 10.0, .lateral_speed_mps = -1.0});
  scene.others.push_back({.id = 2, .s_m = 130.0, .d_m = 4.8, .speed_mps = 10.0});
  EXPECT_EQ(shielded_in(scene, {0, kHold}), (MopAction{0, kHold}));
  scene.others[1].s_m = 118.0;  // it ends where vehicle 2 is
  EXPECT_LT(shielded_in(scene, {0, kHold}).speed_change, kHold);
  scene.others[1].d_m = 8.0;  // vehicle 2 is where it comes from
  EXPECT_EQ(shielded_in(scene, {0, kHold}), (MopAction{0, kHold}));
}

TEST(Shield, DoesNotMoveIntoAVehicleBeside) {
  const Scene beside = with({.id = 1, .s_m = 100.0, .d_m = 4.8 + 1.8 + 0.5, .speed_mps = 10.0});
  EXPECT_EQ(shielded_in(beside, {1, kHold}), (MopAction{0, kHold}));
  EXPECT_EQ(shielded_in(beside, {-1, kHold}), (MopAction{-1, kHold}));
}

TEST(Shield, GetsOutOfTheWayOfAnIntruder) {
  const Scene intruder = with({.id = 1,
                               .s_m = 103.0,
                               .d_m = 4.8 + 1.8 + 0.4,
                               .speed_mps = 10.0,
                               .lateral_speed_mps = -1.0});
  const MopAction action = shielded_in(intruder, {0, kHold});
  EXPECT_EQ(action.corridor_change, -1);
  EXPECT_EQ(action.speed_change, kBrakeHard);
}

// Who changes lane stops in the middle of the next: the lane after that is safe.
TEST(Shield, ExpectsALaneChangeToEndInTheNextLane) {
  const Scene changing =
      with({.id = 1, .s_m = 101.0, .d_m = 11.2, .speed_mps = 10.0, .lateral_speed_mps = -1.0});
  EXPECT_EQ(shielded_in(changing, {0, kHold}), (MopAction{0, kHold}));
}

TEST(Shield, LeavesAFollowerToLookAfterItself) {
  const Scene followed = with({.id = 1, .s_m = 94.0, .d_m = 4.8, .speed_mps = 12.0});
  EXPECT_EQ(shielded_in(followed, {0, kBrakeHard}), (MopAction{0, kBrakeHard}));
}

TEST(Shield, DoesNotMoveInFrontOfAVehicleThatCannotBrakeInTime) {
  Scene scene = with({.id = 1, .s_m = 93.0, .d_m = 6.9, .speed_mps = 25.0});
  EXPECT_NE(shielded_in(scene, {1, kHold}), (MopAction{1, kHold}));
  scene.others[0].s_m = 40.0;
  EXPECT_EQ(shielded_in(scene, {1, kHold}), (MopAction{1, kHold}));
}

TEST(Shield, ChangesNothingMoreOnceItHasChosen) {
  for (const double step_s : {0.5, 1.0}) {
    DrivingSettings settings = kSettings;
    settings.step_s = step_s;
    int changed = 0;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
      const Scene scene = random_scene(seed, settings);
      for (const MopAction& action : all_actions()) {
        const MopAction chosen = shielded(action, scene, settings);
        EXPECT_EQ(shielded(chosen, scene, settings), chosen) << seed;
        changed += chosen != action;
      }
    }
    EXPECT_GT(changed, 0);
  }
}

class AlwaysAccelerate : public MotionPlanner {
 public:
  int decide(const Situation&, const Window&) override { return index_of({0, kAccelerate}); }
};

TEST(ShieldedMop, IsThePlannerBehindTheShield) {
  const DrivingSettings settings = kSettings;
  ShieldedMop mop(std::make_unique<AlwaysAccelerate>(), settings);
  const auto decide = [&](const Scene& scene) {
    return mop_action(
        mop.decide(situation_of(scene, settings), window_for(Command::kKeep, scene.ego, settings)));
  };
  EXPECT_EQ(decide({ego_in_the_middle(), {}}), (MopAction{0, kAccelerate}));
  EXPECT_EQ(decide(with(leader(11.5, 0.0))).speed_change, kBrakeHard);
}

}  // namespace
}  // namespace corridor::driving
