// SPDX-License-Identifier: Apache-2.0
#include "actor/rollout.h"

#include <gtest/gtest.h>

#include <set>

#include "proto/base/failure.h"
#include "proto/base/random.h"
#include "tests/support/fake_world.h"

namespace corridor::actor {
namespace {

using testing_support::FakeWorld;

// Short rounds and episodes, so that a few rounds see ends, cut-offs and open episodes.
RunConfig small_config() {
  RunConfig config;
  config.simulation.episode_steps = 70;
  config.schedule.steps_per_round = 40;
  config.schedule.selection_episodes = 3;
  config.run.actors = 2;
  for (auto& dqn : config.dqn) {
    dqn.steps = 20 * 80;
    dqn.n_step = 4;
    dqn.epsilon_steps = 400;
    dqn.exploration_hold_max = 5;
  }
  return config;
}

std::vector<float> parameters(std::size_t count, std::uint64_t stream) {
  std::vector<float> values(count);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = static_cast<float>(random_unit(stream, Purpose::kInitialWeights, {i}) - 0.5) * 0.4f;
  }
  return values;
}

Weights weights_of(const RunConfig& config, std::uint64_t version) {
  return {version,
          {parameters(config.parameters(Phase::kMop), version),
           parameters(config.parameters(Phase::kBp), version + 1000)}};
}

TimeAccount account;

struct Case {
  const char* name;
  Phase phase;
  MopCommands mop_commands;
};

class InEachPhase : public testing::TestWithParam<Case> {
 protected:
  InEachPhase() { config.schedule.mop_commands = GetParam().mop_commands; }

  RunConfig config = small_config();
  std::uint64_t first = Schedule(config).first_round(GetParam().phase);
};

TEST_P(InEachPhase, GivesTheSameChunksForTheSameRounds) {
  FakeWorld world_a(config), world_b(config);
  PhaseRollout a(config, 1, world_a, account, first, {});
  PhaseRollout b(config, 1, world_b, account, first, {});
  for (std::uint64_t round = first; round < first + 6; ++round) {
    EXPECT_EQ(a.drive_round(weights_of(config, round)), b.drive_round(weights_of(config, round)));
  }
}

TEST_P(InEachPhase, DrivesEachEpisodeInItsOwnTrafficAgainWhenItStartsAnewAndNotInSelection) {
  config.training_traffic.blind_rate_per_s = {0.0, 0.5};
  FakeWorld world(config);
  PhaseRollout rollout(config, 1, world, account, first, {});
  std::set<double> rates;
  for (std::uint64_t round = first; round < first + 4; ++round) {
    const Insert chunk = rollout.drive_round(weights_of(config, round));
    ASSERT_TRUE(world.traffic);
    rates.insert(world.traffic->blind_rate_per_s);
    if (chunk.open.actions.empty()) continue;
    FakeWorld fresh_world(config);
    PhaseRollout fresh(config, 1, fresh_world, account, round + 1, chunk.open);
    ASSERT_TRUE(fresh_world.traffic);
    EXPECT_EQ(fresh_world.traffic->blind_rate_per_s, world.traffic->blind_rate_per_s);
  }
  EXPECT_GE(rates.size(), 2u);
  rollout.select(weights_of(config, first + 4));
  EXPECT_FALSE(world.traffic);
}

TEST_P(InEachPhase, ActorsDriveDifferentEpisodes) {
  FakeWorld world_a(config), world_b(config);
  PhaseRollout a(config, 0, world_a, account, first, {});
  PhaseRollout b(config, 1, world_b, account, first, {});
  EXPECT_NE(a.drive_round(weights_of(config, 0)).rows, b.drive_round(weights_of(config, 0)).rows);
}

TEST_P(InEachPhase, GoesOnBitForBitFromTheOpenEpisodeOfAnyRound) {
  FakeWorld world(config);
  PhaseRollout uninterrupted(config, 1, world, account, first, {});
  std::vector<Insert> chunks;
  for (std::uint64_t round = first; round < first + 8; ++round) {
    chunks.push_back(uninterrupted.drive_round(weights_of(config, round)));
  }
  int resumed_inside_an_episode = 0;
  for (std::size_t done = 1; done < chunks.size(); ++done) {
    FakeWorld fresh_world(config);
    const OpenEpisode& open = chunks[done - 1].open;
    resumed_inside_an_episode += !open.actions.empty();
    PhaseRollout resumed(config, 1, fresh_world, account, first + done, open);
    EXPECT_EQ(resumed.drive_round(weights_of(config, first + done)), chunks[done]) << done;
  }
  EXPECT_GE(resumed_inside_an_episode, 4);
}

TEST_P(InEachPhase, SelectionIsGreedySharedOutAndCutsTheOpenEpisodeOff) {
  FakeWorld world(config);
  PhaseRollout rollout(config, 0, world, account, first, {});
  Insert before;
  do {
    before = rollout.drive_round(weights_of(config, 0));
  } while (before.open.actions.empty());
  const SelectionOutcome outcome = rollout.select(weights_of(config, 1));
  EXPECT_EQ(outcome.round, before.round + 1);
  EXPECT_EQ(outcome.episodes, 2u);  // episodes 0 and 2 of 3
  EXPECT_GT(outcome.steps, 0u);
  EXPECT_EQ(outcome, rollout.select(weights_of(config, 1)));
  const Insert after = rollout.drive_round(weights_of(config, 1));
  EXPECT_GT(after.open.episode, before.open.episode);

  FakeWorld fresh_world(config);
  PhaseRollout resumed(config, 0, fresh_world, account, before.round + 1, before.open);
  resumed.select(weights_of(config, 1));
  EXPECT_EQ(resumed.drive_round(weights_of(config, 1)), after);
}

TEST_P(InEachPhase, EveryRowIsFiniteWithAPriorityOfItsOwn) {
  FakeWorld world(config);
  PhaseRollout rollout(config, 0, world, account, first, {});
  const Insert chunk = rollout.drive_round(weights_of(config, 0));
  const RowLayout layout{config.shape(GetParam().phase).observations};
  ASSERT_EQ(chunk.rows.size(), chunk.priorities.size() * layout.stride());
  EXPECT_GE(chunk.priorities.size(), 30u);
  for (const float value : chunk.rows) ASSERT_TRUE(std::isfinite(value));
  for (const float value : chunk.priorities) ASSERT_GE(value, 0.0f);
}

INSTANTIATE_TEST_SUITE_P(Phases, InEachPhase,
                         testing::Values(Case{"MoP", Phase::kMop, MopCommands::kRandom},
                                         Case{"MoPUnderTheLearnedBp", Phase::kMop,
                                              MopCommands::kLearned},
                                         Case{"BP", Phase::kBp, MopCommands::kRandom}),
                         [](const auto& parameter) { return parameter.param.name; });

TEST(PhaseRollout, TheMopIsTrainedUnderTheLearnedBpsCommandsWhereTheScenarioSaysSo) {
  RunConfig config = small_config();
  config.schedule.mop_commands = MopCommands::kLearned;
  FakeWorld world_a(config), world_b(config);
  PhaseRollout a(config, 0, world_a, account, 0, {});
  PhaseRollout b(config, 0, world_b, account, 0, {});
  Weights weights = weights_of(config, 0);
  const Insert under_one = a.drive_round(weights);
  std::vector<float>& bp = weights.networks[NetworkId::kBp];
  bp = parameters(bp.size(), 77);
  EXPECT_NE(under_one.rows, b.drive_round(weights).rows);
}

TEST(PhaseRollout, ShapingIsInTheRowsOfTheBpAndNotInTheRewardReported) {
  RunConfig plain = small_config();
  plain.dqn[1].n_step = 1;
  plain.dqn[1].reward_scale = 1.0;
  plain.bp_reward.lane_change_shaping = 0.0;
  RunConfig shaped = plain;
  shaped.bp_reward.lane_change_shaping = -3.0;
  const std::uint64_t first = Schedule(plain).first_round(Phase::kBp);
  FakeWorld world_a(plain, 0), world_b(shaped, 0);
  PhaseRollout a(plain, 0, world_a, account, first, {});
  PhaseRollout b(shaped, 0, world_b, account, first, {});
  const RowLayout layout{plain.shape(Phase::kBp).observations};
  int changes = 0;
  for (std::uint64_t round = first; round < first + 10; ++round) {
    const std::vector<float> rows_a = a.drive_round(weights_of(plain, round)).rows;
    const std::vector<float> rows_b = b.drive_round(weights_of(shaped, round)).rows;
    ASSERT_EQ(rows_a.size(), rows_b.size());
    for (std::size_t i = layout.n_step_return(); i < rows_a.size(); i += layout.stride()) {
      if (rows_a[i] == rows_b[i]) continue;
      ++changes;
      EXPECT_EQ(rows_b[i], rows_a[i] - 3.0f);
    }
  }
  EXPECT_GT(changes, 0);
  EXPECT_EQ(a.take_totals().reward, b.take_totals().reward);
}

TEST(PhaseRollout, RefusesAnEpisodeLongerThanItsPhase) {
  const RunConfig config = small_config();
  FakeWorld world(config);
  EXPECT_THROW(PhaseRollout(config, 0, world, account, 1, {0, std::vector<std::uint8_t>(41, 0)}),
               Failure);
}

TEST(PhaseRollout, RefusesActionsUnderCommandsThatTheRandomBpDidNotGive) {
  const RunConfig config = small_config();
  FakeWorld world(config, 0);
  std::vector<std::uint8_t> actions;
  for (int i = 0; i < 40; ++i) {
    actions.push_back(driving::pack(i % 2 ? driving::Command::kLeft : driving::Command::kRight, 4));
  }
  EXPECT_THROW(PhaseRollout(config, 0, world, account, 1, {0, actions}), Failure);
}

}  // namespace
}  // namespace corridor::actor
