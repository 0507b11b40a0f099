// SPDX-License-Identifier: Apache-2.0
#include "actor/episode.h"

#include <gtest/gtest.h>

#include "actor/driving/fixed_bp.h"
#include "actor/driving/rules.h"
#include "tests/actor/driving/more_skills.h"
#include "tests/support/fake_world.h"

namespace corridor::actor {
namespace {

using driving::Command;
using testing_support::FakeWorld;

constexpr int kThere = 10;  // step at which the planner below turns back

// A planner that no product has: half a lane to the left, and back.
class ThereAndBack : public driving::BehaviourPlanner {
 public:
  void begin_episode(std::uint64_t) override { asked_ = 0; }
  Command decide(const driving::Situation&) override {
    return asked_++ < kThere ? driving::kHalfLeft : Command::kKeep;
  }

 private:
  int asked_ = 0;
};

class EpisodeTest : public testing::Test {
 protected:
  RunConfig config_;
  DrivingSettings settings_ = driving_settings(config_);
  driving::Lanes lanes_{settings_};
  FakeWorld world_{config_, 0};
  driving::RuleBasedMop mop_{settings_};
};

TEST_F(EpisodeTest, DrivesASkillAndAPlannerThatATestHasAdded) {
  Episode episode(config_, world_, driving::kMoreSkills);
  ThereAndBack bp;
  drive(episode, {.seed = 1}, bp, mop_, kThere);
  EXPECT_EQ(lanes_.corridor_at(episode.scene().ego.d_m), 9) << "at the left edge of lane 1";
  EXPECT_EQ(episode.situation().previous, driving::kHalfLeft);
  drive(episode, {.seed = 1}, bp, mop_, 2 * kThere);
  EXPECT_EQ(lanes_.corridor_at(episode.scene().ego.d_m), 7) << "in its middle again";
  EXPECT_EQ(episode.situation().previous, Command::kKeep);
  EXPECT_EQ(episode.summary().lane_changes, 0);
}

TEST_F(EpisodeTest, IsDrivenAgainByItsActionsWithTheSameSkills) {
  Episode first(config_, world_, driving::kMoreSkills);
  ThereAndBack bp;
  drive(first, {.seed = 1}, bp, mop_, 2 * kThere);
  Episode again(config_, world_, driving::kMoreSkills);
  again.begin({.seed = 1});
  for (const std::uint8_t packed : first.actions()) {
    const auto action = driving::unpack(packed, static_cast<int>(again.skills().size()));
    again.step(action.command, action.mop_action);
  }
  EXPECT_EQ(again.trajectory_hash(), first.trajectory_hash());
}

TEST_F(EpisodeTest, CarriesOutWhatIsFeasibleInPlaceOfWhatIsNot) {
  Episode episode(config_, world_);
  driving::FixedBp left(Command::kLeft, settings_);
  drive(episode, {.seed = 1}, left, mop_, 30);
  EXPECT_EQ(lanes_.corridor_at(episode.scene().ego.d_m), lanes_.middle_of_lane(2));
  EXPECT_EQ(episode.window(Command::kLeft).first, episode.window(Command::kKeep).first);
  episode.step(Command::kLeft, 1);
  EXPECT_EQ(episode.situation().previous, Command::kKeep);
}

}  // namespace
}  // namespace corridor::actor
