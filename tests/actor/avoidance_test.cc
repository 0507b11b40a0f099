// SPDX-License-Identifier: Apache-2.0
#include "actor/avoidance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "actor/driving/action.h"
#include "actor/redrive.h"
#include "actor/world/sumo_world.h"
#include "proto/base/failure.h"
#include "proto/run/evaluation_record.h"
#include "proto/settings/collision_kinds.h"
#include "proto/settings/sumo_names.h"
#include "proto/system/files.h"
#include "scenarios/sumo_files.h"
#include "tests/support/fake_world.h"
#include "tests/support/recorded_collision.h"
#include "tests/support/temporary_directory.h"

namespace corridor::actor {
namespace {

using driving::Collision;
using driving::Scene;
using driving::Vehicle;
using testing::HasSubstr;
using testing::ThrowsMessage;
using testing_support::FakeWorld;
using testing_support::record_collision;
using testing_support::TemporaryDirectory;

constexpr int kOther = 7;

// The ego in the middle lane, and one vehicle 3.2 m to its left that moves across at this speed.
Scene beside(double lateral_speed_mps) {
  Scene scene;
  scene.ego = {.s_m = 100.0, .d_m = 4.8, .speed_mps = 10.0, .set_point_mps = 10.0};
  scene.others = {Vehicle{.id = kOther,
                          .s_m = 101.0,
                          .d_m = 8.0,
                          .speed_mps = 10.0,
                          .lateral_speed_mps = lateral_speed_mps}};
  return scene;
}

constexpr Collision kSideByOther{CollisionKind::kSideByOther, kOther};
constexpr Collision kSideByEgo{CollisionKind::kSideByEgo, kOther};
constexpr Collision kRearEnded{CollisionKind::kRearEnded, kOther};

TEST(EvasiveActions, BeginAwayFromTheOtherWithTheHardestBraking) {
  const DrivingSettings settings = driving_settings(RunConfig{});
  const auto actions = evasive_actions(beside(-1.0), kSideByOther, settings);
  EXPECT_EQ(driving::mop_action(actions.front()), (driving::MopAction{-1, 0}));
  EXPECT_EQ(driving::mop_action(actions.back()).corridor_change, 1);
  const auto forward = evasive_actions(beside(-1.0), kRearEnded, settings);
  const int fastest = static_cast<int>(settings.planner.speed_changes_mps.size()) - 1;
  EXPECT_EQ(driving::mop_action(forward.front()), (driving::MopAction{-1, fastest}));
}

TEST(EvasiveActions, LeadToEveryTargetOnceAndAreStraightWhereTheRoadEnds) {
  const DrivingSettings settings = driving_settings(RunConfig{});
  const int all = 3 * static_cast<int>(settings.planner.speed_changes_mps.size());
  for (const double d_m : {1.0, 4.8, 8.6}) {
    for (const double set_point_mps : {0.0, 10.0, settings.road.speed_limit_mps}) {
      Scene scene = beside(0.0);
      scene.ego.d_m = d_m;
      scene.ego.set_point_mps = set_point_mps;
      using Key = std::pair<int, double>;
      std::set<Key> possible, led_to;
      for (int action = 0; action < all; ++action) {
        const auto target = driving::target_for(driving::mop_action(action), scene.ego, settings);
        possible.insert({target.corridor, target.set_point_mps});
      }
      const auto actions = evasive_actions(scene, kSideByOther, settings);
      for (const int action : actions) {
        const driving::MopAction parts = driving::mop_action(action);
        const auto target = driving::target_for(parts, scene.ego, settings);
        led_to.insert({target.corridor, target.set_point_mps});
        const auto straight = driving::target_for({0, parts.speed_change}, scene.ego, settings);
        EXPECT_EQ(parts.corridor_change == 0, target == straight) << action << " at " << d_m;
      }
      EXPECT_EQ(led_to, possible) << d_m << " " << set_point_mps;
      EXPECT_EQ(actions.size(), possible.size()) << d_m << " " << set_point_mps;
    }
  }
}

TEST(ActionsInSight, CountTheLastUnbrokenRunInWhichTheOtherComesNearer) {
  const EgoSettings ego;
  const auto count = [&](std::vector<Scene> seen, const Collision& collision) {
    return actions_in_sight(seen, collision, ego);
  };
  EXPECT_EQ(count({}, kSideByOther), 0);
  EXPECT_EQ(count({beside(-1.0), beside(0.0)}, kSideByOther), 0);
  EXPECT_EQ(count({beside(-1.0), beside(0.0), beside(-1.0), beside(-0.2)}, kSideByOther), 2);
  EXPECT_EQ(count({beside(1.0)}, kSideByOther), 0) << "it moves away";
  EXPECT_EQ(count({beside(-kVisible_mps)}, kSideByOther), 0) << "too slow to be seen";
}

TEST(ActionsInSight, AVehicleInThePathOrOneThatTheEgoMovesIntoIsInSightWhenItIsThere) {
  const EgoSettings ego;
  Scene ahead = beside(0.0);
  ahead.others[0].d_m = ahead.ego.d_m + 1.0;
  EXPECT_EQ(actions_in_sight(std::vector{ahead, ahead}, kSideByOther, ego), 2);
  EXPECT_EQ(actions_in_sight(std::vector{beside(0.0), beside(0.0)}, kSideByEgo, ego), 2);
  Scene alone = beside(0.0);
  alone.others.clear();
  EXPECT_EQ(actions_in_sight(std::vector{alone, beside(0.0)}, kSideByEgo, ego), 1);
}

TEST(Verdicts, WhatFewerActionsCouldAvoidMoreCould) {
  const std::vector searched = {Verdict::kUnavoidable, Verdict::kAvoidable};
  EXPECT_EQ(by_last(1, searched), Verdict::kUnavoidable);
  EXPECT_EQ(by_last(2, searched), Verdict::kAvoidable);
  EXPECT_EQ(by_last(4, searched), Verdict::kAvoidable);
}

TEST(Verdicts, ReactingHasTheActionsInSightOnly) {
  using enum Verdict;
  EXPECT_EQ(by_reacting(0, std::vector{kAvoidable}), kUnavoidable);
  EXPECT_EQ(by_reacting(1, std::vector{kAvoidable}), kAvoidable);
  EXPECT_EQ(by_reacting(1, std::vector{kUnavoidable, kAvoidable}), kUnavoidable);
  EXPECT_EQ(by_reacting(2, std::vector{kUnavoidable, kAvoidable}), kAvoidable);
  EXPECT_EQ(by_reacting(9, std::vector{kUnavoidable, kAvoidable}), kAvoidable);
  EXPECT_EQ(by_reacting(2, std::vector{kUnavoidable, kUndecided}), kUndecided);
  EXPECT_EQ(by_reacting(9, std::vector{kUnavoidable, kUnavoidable}), kUndecided)
      << "more could be done than was searched";
}

class LookBack : public testing::Test {
 protected:
  LookBack() { config_.simulation.episode_steps = 100; }

  TemporaryDirectory temporary_;
  RunConfig config_;
};

TEST_F(LookBack, AnEscapeThatIsFoundInSumoEscapesWhenDrivenAgain) {
  config_.simulation.episode_steps = 300;
  scenarios::write_sumo_files(config_, temporary_.path());
  TimeAccount time;
  world::SumoWorld world(world::world_settings(config_), temporary_.path() / kSumoNetworkFile,
                         temporary_.path() / kSumoRoutesFile, time);
  const RecordedEpisode episode = record_collision(config_, world);
  const CollisionHindsight hindsight = look_back(config_, episode, world, {});
  const int actions = static_cast<int>(hindsight.attempts.size());
  ASSERT_EQ(hindsight.by_last_actions[actions - 1], Verdict::kAvoidable);
  const auto& escape = hindsight.escape;
  EXPECT_EQ(escape.size(), static_cast<std::size_t>(actions + kMarginSteps));

  Episode again(config_, world);
  again.begin(start_of(episode));
  while (again.summary().steps < episode.summary.steps - actions) step_as_recorded(again, episode);
  for (const std::uint8_t action : escape) {
    again.step(driving::Command::kKeep, action);
    EXPECT_FALSE(again.summary().collision) << "step " << again.summary().steps;
  }
  EXPECT_EQ(again.summary().steps, episode.summary.steps + kMarginSteps);

  const CollisionHindsight twice = look_back(config_, episode, world, {});
  EXPECT_EQ(twice, hindsight);
}

// Somebody hits the ego in a certain step, whatever it does.
class DoomedWorld : public FakeWorld {
 public:
  static constexpr int kStep = 6;
  explicit DoomedWorld(const RunConfig& config) : FakeWorld(config, 0) {}
  driving::Scene begin(const world::EpisodeStart& start) override {
    steps_ = 0;
    return FakeWorld::begin(start);
  }
  world::StepResult step(const driving::Trajectory& trajectory) override {
    world::StepResult result = FakeWorld::step(trajectory);
    if (++steps_ == kStep) result.collision = kSideByOther;
    return result;
  }

 private:
  int steps_ = 0;
};

TEST_F(LookBack, WhatHappensWhateverTheEgoDoesIsUnavoidable) {
  DoomedWorld world(config_);
  const RecordedEpisode episode = record_collision(config_, world);
  ASSERT_EQ(episode.summary.steps, DoomedWorld::kStep);
  const CollisionHindsight hindsight =
      look_back(config_, episode, world, {.actions = 2, .attempts_max = 500});
  EXPECT_EQ(hindsight.by_last_actions[0], Verdict::kUnavoidable);
  EXPECT_EQ(hindsight.by_last_actions[1], Verdict::kUnavoidable);
  EXPECT_GT(hindsight.attempts[1], hindsight.attempts[0]);
  EXPECT_EQ(hindsight.step, DoomedWorld::kStep);
  EXPECT_EQ(hindsight.collision_kind, CollisionKind::kSideByOther);

  const CollisionHindsight short_of =
      look_back(config_, episode, world, {.actions = 1, .attempts_max = 3});
  EXPECT_EQ(short_of.by_last_actions[0], Verdict::kUndecided);
  EXPECT_EQ(short_of.attempts[0], 3);
}

TEST_F(LookBack, RefusesEpisodesWithoutACollisionAndThoseThatDoNotDriveAsRecorded) {
  FakeWorld world(config_);
  RecordedEpisode episode = record_collision(config_, world);
  RecordedEpisode other = episode;
  other.trajectory_hash = "0123456789abcdef";
  EXPECT_THAT([&] { look_back(config_, other, world, {}); },
              ThrowsMessage<Failure>(HasSubstr("does not drive again as recorded")));

  Episode free(config_, world);
  free.begin(start_of(episode));
  free.step(driving::Command::kKeep, 1);
  episode.actions = free.actions();
  episode.summary = record_of(free.summary(), 1);
  episode.trajectory_hash = free.trajectory_hash();
  EXPECT_THAT([&] { look_back(config_, episode, world, {}); },
              ThrowsMessage<Failure>(HasSubstr("ends without a collision")));
}

// An evaluation of two episodes, the second of which ends in a collision.
class HindsightReport : public testing::Test {
 protected:
  HindsightReport() {
    config_.simulation.episode_steps = 100;
    FakeWorld world(config_);
    const RecordedEpisode second = record_collision(config_, world);
    write_recorded_episode(run_, second);
    EpisodeRecord first;
    first.steps = 1234;
    write_evaluation(run_, evaluation_of({"rules", 5}, 1.0, {first, second.summary}));
  }

  std::string report(bool go_on = true) {
    FakeWorld world(config_);
    report_hindsight(config_, {"rules", 5, {}}, run_, world,
                     [&](std::int64_t done, std::int64_t of) {
                       EXPECT_EQ(done, 1);
                       EXPECT_EQ(of, 1);
                       return go_on;
                     });
    const auto file = run_.hindsight({"rules", 5});
    return std::filesystem::exists(file) ? read_file(file) : "";
  }

  TemporaryDirectory temporary_;
  RunDirectory run_ = RunDirectory::create(temporary_.path() / "run");
  RunConfig config_;
};

TEST_F(HindsightReport, HasARecordOfEveryCollision) {
  report();
  const HindsightRecord written = read_hindsight(run_.hindsight({"rules", 5}));
  EXPECT_EQ(written.planner, "rules");
  EXPECT_EQ(written.seed, 5u);
  EXPECT_EQ(written.limits, HindsightLimits{});
  ASSERT_EQ(written.collisions.size(), 1u);
  const CollisionHindsight& collision = written.collisions[0];
  EXPECT_EQ(written.steps, 1234 + collision.step);
  EXPECT_EQ(collision.episode, 1u);
  EXPECT_EQ(collision.collision_kind, CollisionKind::kRearEnding);
  EXPECT_EQ(collision.by_last_actions.size(), 4u);
  EXPECT_EQ(collision.recorded, (std::vector<int>{16, 16, 16, 16})) << "straight on, ever faster";
  EXPECT_EQ(collision.escape.size(), collision.attempts.size() + kMarginSteps);
  EXPECT_GT(collision.actions_in_sight, 0);
}

TEST_F(HindsightReport, TwiceWritesEqualFiles) {
  const std::string first = report();
  EXPECT_FALSE(first.empty());
  EXPECT_EQ(report(), first);
}

TEST_F(HindsightReport, StoppedWritesNothing) { EXPECT_EQ(report(false), ""); }

TEST_F(HindsightReport, RefusesWhatIsNoEvaluation) {
  write_file(run_.evaluation({"rules", 5}), "{}");
  EXPECT_THAT([&] { report(); }, ThrowsMessage<Failure>(HasSubstr("is no evaluation")));
  std::filesystem::remove(run_.evaluation({"rules", 5}));
  EXPECT_THROW(report(), Failure);
}

}  // namespace
}  // namespace corridor::actor
