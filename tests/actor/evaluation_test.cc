#include "actor/evaluation.h"

#include <gtest/gtest.h>

#include "proto/base/failure.h"
#include "proto/base/json.h"
#include "proto/system/files.h"
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

  Json evaluate_pair(const char* pair, std::int64_t steps = 150) {
    FakeWorld world(config);
    actor::evaluate(config, networks, {planner_pair(pair), 5, steps, {}}, run, world,
                    [](std::int64_t) { return true; });
    return read_json(run.evaluation() / (std::string(pair) + "_5.json"));
  }

  TemporaryDirectory temporary;
  RunDirectory run;
  RunConfig config;
  Networks networks;
};

TEST_F(Evaluation, DrivesExactlyTheStepsAskedForAndSumsThemUp) {
  const Json totals = evaluate_pair("rules");
  EXPECT_EQ(totals["steps"], 150);
  EXPECT_EQ(totals["episodes"], totals["per_episode"].size());
  std::int64_t steps = 0;
  double reward = 0.0;
  for (const Json& episode : totals["per_episode"]) {
    steps += episode["steps"].get<std::int64_t>();
    reward += episode["bp_reward"].get<double>();
    std::int64_t lane_steps = 0;
    for (const auto& count : episode["lane_steps"]) lane_steps += count.get<std::int64_t>();
    EXPECT_EQ(lane_steps, episode["steps"].get<std::int64_t>());
  }
  EXPECT_EQ(steps, 150);
  EXPECT_DOUBLE_EQ(totals["bp_reward_per_1000"].get<double>(), 1000.0 * reward / 150.0);
  std::int64_t by_kind = 0;
  for (const auto& [kind, count] : totals["collisions_by_kind"].items()) {
    by_kind += count.get<std::int64_t>();
  }
  EXPECT_EQ(by_kind, totals["collisions"].get<std::int64_t>());
}

TEST_F(Evaluation, GivesEveryPairTheSameTraffic) {
  for (const PlannerPair& pair : kPlannerPairs) {
    evaluate_pair(pair.name, 30);
    const Json episode = read_json(run.episodes() / (std::string(pair.name) + "_5_0.json"));
    EXPECT_EQ(episode["episode_seed"].get<std::uint64_t>(), test_episode_seed(5, 0)) << pair.name;
  }
}

TEST_F(Evaluation, WritesTheSameFilesTwice) {
  const Json first = evaluate_pair("hierarchical");
  EXPECT_EQ(first, evaluate_pair("hierarchical"));
}

TEST_F(Evaluation, AnEpisodeDrivenAgainHasTheSameTrajectory) {
  for (const char* pair : {"rules", "hierarchical", "sumo", "random+rules"}) {
    evaluate_pair(pair);
    FakeWorld world(config);
    const Redriven result =
        redrive(config, run.episodes() / (std::string(pair) + "_5_1.json"), world, {});
    EXPECT_EQ(result.hash, result.recorded_hash) << pair;
    EXPECT_GT(result.summary.steps, 0);
  }
}

TEST_F(Evaluation, AChangedActionChangesTheTrajectory) {
  evaluate_pair("rules");
  const auto file = run.episodes() / "rules_5_0.json";
  Json episode = read_json(file);
  const int old_action = episode["actions"][3].get<int>();
  episode["actions"][3] = old_action == 0 ? 26 : 0;
  write_file(file, episode.dump());
  FakeWorld world(config);
  const Redriven result = redrive(config, file, world, {});
  EXPECT_NE(result.hash, result.recorded_hash);
}

TEST_F(Evaluation, RefusesWhatIsNoEpisode) {
  FakeWorld world(config);
  const auto file = temporary.path() / "file.json";
  EXPECT_THROW(redrive(config, file, world, {}), Failure);
  write_file(file, "{}");
  EXPECT_THROW(redrive(config, file, world, {}), Failure);
  evaluate_pair("rules");
  Json episode = read_json(run.episodes() / "rules_5_0.json");
  episode["actions"].erase(0);
  write_file(file, episode.dump());
  EXPECT_THROW(redrive(config, file, world, {}), Failure);
  episode = read_json(run.episodes() / "rules_5_0.json");
  episode["actions"][0] = 255;
  write_file(file, episode.dump());
  EXPECT_THROW(redrive(config, file, world, {}), Failure);
}

}  // namespace
}  // namespace corridor::actor
