// SPDX-License-Identifier: Apache-2.0
#include "proto/config/config_values.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <sstream>

#include "tests/support/failure_of.h"

namespace corridor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> names_of(const std::vector<ChangedKey>& keys) {
  std::vector<std::string> names;
  for (const ChangedKey& key : keys) names.push_back(key.name);
  return names;
}

// A document's text, however its lines are wrapped.
std::string document(const char* name) {
  std::ifstream in(std::string(CORRIDOR_SOURCE_DIR) + "/docs/" + name);
  std::ostringstream out;
  out << in.rdbuf();
  return std::regex_replace(std::regex_replace(out.str(), std::regex("`"), ""), std::regex("\\s+"),
                            " ");
}

// Whoever gives a key another part to play says so here and in the documents.
TEST(ConfigKeys, ThatAnEvaluationsWorldSetsAreThese) {
  EXPECT_EQ(keys_where(set_by_world),
            "[road], [simulation], [traffic], [ego], [dynamics], planner.corridor_change_s, "
            "[bp_reward], [evaluation]");
}

TEST(ConfigKeys, ThatMayChangeInTheMiddleOfATrainingAreTheseAndDocumented) {
  const std::string keys = keys_where([](Heeds heeds) { return !decides_result(heeds); });
  EXPECT_EQ(keys,
            "schedule.checkpoint_every_steps, schedule.checkpoints_kept, [evaluation], "
            "run.transport, run.host, run.replay_port, run.learner_port, run.peer_timeout_s");
  EXPECT_THAT(document("operations.md"), HasSubstr(keys));
}

TEST(ConfigValues, ThatDifferAreNamedInTheirOrderAndSayWhetherTheyDecideTheResult) {
  RunConfig now;
  now.evaluation.steps = 7;
  now.dynamics.world = WorldKind::kSlip;
  now.dqn[0].gamma = 0.5;
  const std::vector<ChangedKey> changed = changed_keys({}, now);
  EXPECT_THAT(names_of(changed), ElementsAre("dynamics.world", "mop.gamma", "evaluation.steps"));
  EXPECT_EQ(changed[0].before, "\"kinematic\"");
  EXPECT_EQ(changed[0].now, "\"slip\"");
  EXPECT_TRUE(decides_result(changed[1].heeds));
  EXPECT_FALSE(decides_result(changed[2].heeds));
  EXPECT_THAT(changed_keys(now, now), testing::IsEmpty());
}

TEST(ConfigValues, InAnotherWorldThePlannersAreThoseThatWereTrained) {
  RunConfig trained, world;
  world.traffic.vehicles_max = 17;
  world.planner.corridor_change_s = 2.0;
  world.evaluation.seeds = {7, 8};
  world.planner.side_clearance_m = 0.3;
  world.dqn[0].gamma = 0.5;
  world.run.seed = 9;
  world.schedule.checkpoints_kept = 5;
  const RunConfig config = in_world(trained, world, "x");
  EXPECT_THAT(names_of(changed_keys(trained, config)),
              ElementsAre("traffic.vehicles_max", "planner.corridor_change_s", "evaluation.seeds"));
  EXPECT_EQ(config.traffic.vehicles_max, 17);
  EXPECT_EQ(config.evaluation.seeds, world.evaluation.seeds);
}

TEST(ConfigValues, AWorldThatTheTrainedPlannersDoNotFitIsRefused) {
  RunConfig trained, world;
  trained.planner.side_clearance_m = 0.6;
  world.traffic.objects_per_km = 3.0;
  EXPECT_THAT(failure_of([&] { in_world(trained, world, "partial"); }),
              HasSubstr("partial: traffic.object_width_m"));
}

TEST(ConfigValues, AreWrittenWithWhatTheirChoicesMean) {
  EXPECT_THAT(to_toml({}),
              HasSubstr("device = \"cpu\"                        # of the learner; cpu: "
                        "BLAS on the processor; cuda: LibTorch on a GPU\n"));
}

}  // namespace
}  // namespace corridor
