// SPDX-License-Identifier: Apache-2.0
#include "cluster/report/report_episodes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cluster/report/run_record.h"
#include "tests/support/fake_run.h"
#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

EpisodeRecord episode(std::int64_t steps, double bp_reward, std::int64_t collisions) {
  EpisodeRecord result;
  result.steps = steps;
  result.bp_reward = bp_reward;
  result.collisions = collisions;
  return result;
}

EvaluationRecord evaluation(std::uint64_t seed, std::vector<EpisodeRecord> episodes) {
  EvaluationRecord result;
  result.planner = "rules";
  result.seed = seed;
  result.per_episode = std::move(episodes);
  for (std::size_t i = 0; i < result.per_episode.size(); ++i) result.per_episode[i].episode = i;
  return result;
}

TEST(TypicalEpisode, IsTheMedianOfTheWholeOnesWithoutCollision) {
  const std::vector<EvaluationRecord> results = {
      evaluation(7, {episode(1000, 300, 0), episode(800, 350, 1), episode(1000, 500, 0)}),
      evaluation(8, {episode(1000, 420, 0), episode(200, 10, 0)})};
  EXPECT_EQ(typical_episode(results), (EpisodeName{"rules", 8, 0}));
  EXPECT_EQ(typical_episode(results)->text(), "rules_8_0");
}

TEST(TypicalEpisode, IsNoneWhereEveryEpisodeEndsInACollision) {
  EXPECT_EQ(typical_episode({evaluation(7, {episode(500, 100, 1)})}), std::nullopt);
}

TEST(FailedEpisode, IsTheFirstWithACollisionThatHasABefore) {
  const std::vector<EvaluationRecord> results = {
      evaluation(7, {episode(1000, 300, 0), episode(2, 1, 1)}),
      evaluation(8, {episode(600, 300, 1), episode(500, 200, 1)})};
  EXPECT_EQ(failed_episode(results), (EpisodeName{"rules", 8, 0}));
  EXPECT_EQ(failed_episode({results[0]}), std::nullopt);
}

TEST(ReportEpisodes, SaysWhichEpisodeCannotBeDrivenAgain) {
  testing_support::TemporaryDirectory temporary;
  testing_support::make_fake_run(temporary.path() / "run", testing_support::fake_run_config(1));
  const ReportedEpisodes reported =
      report_episodes(grouped_runs({read_run(temporary.path() / "run")}));
  EXPECT_TRUE(reported.figures.empty());
  EXPECT_THAT(reported.notes, ElementsAre(HasSubstr("no picture of rules_1002_0: "),
                                          HasSubstr("no picture of random+rules_1002_0: ")));
}

}  // namespace
}  // namespace corridor::cluster
