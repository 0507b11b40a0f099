// SPDX-License-Identifier: Apache-2.0
#include "actor/tracer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "actor/evaluation.h"
#include "proto/base/failure.h"
#include "proto/run/recorded_episode.h"
#include "tests/support/fake_world.h"
#include "tests/support/temporary_directory.h"

namespace corridor::actor {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;
using testing_support::FakeWorld;

class TraceEpisode : public testing::Test {
 protected:
  TraceEpisode() : run_(RunDirectory::create(temporary_.path() / "run")) {
    config_.simulation.episode_steps = 40;
  }

  std::filesystem::path evaluated(const std::string& pair) {
    FakeWorld world(config_);
    actor::evaluate(config_, {}, {pair, 5, 40}, run_, world, [](std::int64_t) { return true; });
    return run_.episode({pair, 5, 0});
  }

  testing_support::TemporaryDirectory temporary_;
  RunDirectory run_;
  RunConfig config_;
};

TEST_F(TraceEpisode, HasTheStartAndWhatEachStepLedTo) {
  const std::filesystem::path file = evaluated("left+rules");
  FakeWorld world(config_);
  const EpisodeTrace trace = trace_episode(config_, nullptr, file, world);
  const EpisodeRecord summary = read_recorded_episode(file).summary;
  ASSERT_EQ(std::ssize(trace.steps), summary.steps + 1);
  EXPECT_EQ(trace.bp_reward, summary.bp_reward);
  EXPECT_EQ(trace.lane_changes, summary.lane_changes);
  EXPECT_EQ(trace.collision.has_value(), summary.collisions == 1);
  EXPECT_NEAR(trace.steps.back().ego.s_m - trace.steps.front().ego.s_m, summary.distance_m, 1e-9);
  EXPECT_TRUE(trace.steps.front().command);
  EXPECT_FALSE(trace.steps.back().command);
  EXPECT_EQ(trace.steps.front().ego.length_m, config_.ego.length_m);
  ASSERT_TRUE(trace.steps.front().decision);
  EXPECT_FALSE(trace.steps.back().decision);
  const TracedDecision& decision = *trace.steps.front().decision;
  EXPECT_TRUE(decision.bp_values.empty()) << "nothing is learned";
  EXPECT_EQ(decision.front_gaps_m.size(), 15u);
  EXPECT_GT(decision.path_s_m.back(), decision.path_s_m.front());
  double reward = 0.0;
  for (const TracedStep& step : trace.steps) {
    if (step.decision) reward += step.decision->bp_reward;
  }
  EXPECT_NEAR(reward, trace.bp_reward, 1e-9);
}

TEST_F(TraceEpisode, OfANewDriveIsThatOfTheEvaluationsEpisode) {
  const EpisodeTrace recorded = [&] {
    const std::filesystem::path file = evaluated("left+rules");
    FakeWorld world(config_);
    return trace_episode(config_, nullptr, file, world);
  }();
  FakeWorld world(config_);
  const EpisodeTrace driven =
      trace_drive(config_, {}, planner_pair("left+rules"), test_episode_seed(5, 0), 40, world);
  EXPECT_EQ(json_of(driven), json_of(recorded));
}

TEST_F(TraceEpisode, HasTheValuesThatLearnedPlannersChoseBy) {
  Networks networks;
  for (const NamedNetwork& network : kNetworks) {
    networks[network.id].assign(config_.parameters(network.id), 0.01f);
  }
  FakeWorld world(config_);
  const EpisodeTrace trace =
      trace_drive(config_, networks, planner_pair("hierarchical"), 3, 5, world);
  EXPECT_EQ(trace.commands, (std::vector<std::string>{"keep", "left", "right"}));
  for (const TracedStep& step : trace.steps) {
    if (!step.decision) continue;
    EXPECT_EQ(step.decision->bp_values.size(), 3u);
    ASSERT_EQ(step.decision->mop_values.size(), 18u);
    const auto best = std::ranges::max_element(step.decision->mop_values);
    EXPECT_EQ(step.decision->mop_action, best - step.decision->mop_values.begin());
  }
}

TEST_F(TraceEpisode, HasNoCommandsWhereTheWorldDrives) {
  const std::filesystem::path file = evaluated("sumo");
  FakeWorld world(config_);
  for (const TracedStep& step : trace_episode(config_, nullptr, file, world).steps) {
    EXPECT_FALSE(step.command);
  }
}

TEST_F(TraceEpisode, IsRefusedWhenItDoesNotDriveAgainAsRecorded) {
  const std::filesystem::path file = evaluated("rules");
  RecordedEpisode episode = read_recorded_episode(file);
  episode.trajectory_hash = "0123456789abcdef";
  write_recorded_episode(run_, episode);
  FakeWorld world(config_);
  EXPECT_THAT([&] { trace_episode(config_, nullptr, file, world); },
              ThrowsMessage<Failure>(HasSubstr("does not drive again as recorded")));
}

}  // namespace
}  // namespace corridor::actor
