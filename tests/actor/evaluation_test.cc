// SPDX-License-Identifier: Apache-2.0
#include "actor/evaluation.h"

#include <gtest/gtest.h>

#include <numeric>

#include "proto/run/recorded_episode.h"
#include "tests/support/fake_world.h"
#include "tests/support/temporary_directory.h"

namespace corridor::actor {
namespace {

using testing_support::FakeWorld;
using testing_support::TemporaryDirectory;

class Evaluation : public testing::Test {
 protected:
  Evaluation() : run(RunDirectory::create(temporary.path() / "run")) {
    config.simulation.episode_steps = 60;
    networks = {std::vector<float>(config.parameters(Phase::kMop), 0.01f),
                std::vector<float>(config.parameters(Phase::kBp), 0.01f)};
  }

  EvaluationRecord evaluate_pair(const std::string& planner, std::int64_t steps = 150) {
    FakeWorld world(config);
    actor::evaluate(config, networks, {planner, 5, steps}, run, world,
                    [](std::int64_t) { return true; });
    return read_evaluation(run.evaluation({planner, 5}));
  }

  TemporaryDirectory temporary;
  RunDirectory run;
  RunConfig config;
  Networks networks;
};

TEST_F(Evaluation, DrivesExactlyTheStepsAskedForAndSumsThemUp) {
  const EvaluationRecord record = evaluate_pair("rules");
  EXPECT_EQ(record.steps, 150);
  EXPECT_EQ(record.step_s, config.simulation.step_s);
  EXPECT_EQ(record, evaluation_of({"rules", 5}, config.simulation.step_s, record.per_episode));
  for (const EpisodeRecord& episode : record.per_episode) {
    EXPECT_EQ(
        std::accumulate(episode.lane_steps.begin(), episode.lane_steps.end(), std::int64_t{0}),
        episode.steps);
  }
}

TEST_F(Evaluation, GivesEveryPairTheSameTraffic) {
  for (const PlannerPair& pair : kPlannerPairs) {
    evaluate_pair(pair.name, 30);
    const RecordedEpisode episode = read_recorded_episode(run.episode({pair.name, 5, 0}));
    EXPECT_EQ(episode.episode_seed, test_episode_seed(5, 0)) << pair.name;
    EXPECT_EQ(episode.name(), (EpisodeName{pair.name, 5, 0}));
  }
}

TEST_F(Evaluation, WritesTheSameFilesTwice) {
  const EvaluationRecord first = evaluate_pair("hierarchical");
  EXPECT_EQ(first, evaluate_pair("hierarchical"));
}

TEST_F(Evaluation, StoppedWritesNoTotals) {
  FakeWorld world(config);
  actor::evaluate(config, networks, {"rules", 5, 150}, run, world,
                  [](std::int64_t) { return false; });
  EXPECT_TRUE(std::filesystem::exists(run.episode({"rules", 5, 0})));
  EXPECT_FALSE(std::filesystem::exists(run.evaluation({"rules", 5})));
}

}  // namespace
}  // namespace corridor::actor
