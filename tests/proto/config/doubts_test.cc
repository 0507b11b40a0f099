// SPDX-License-Identifier: Apache-2.0
#include "proto/config/doubts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/config/run_config.h"

namespace corridor {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Doubts, ThereAreNoneAboutTheScenariosOfTheRepository) {
  const auto scenarios = std::filesystem::path(CORRIDOR_SOURCE_DIR) / "scenarios";
  for (const auto& entry : std::filesystem::directory_iterator(scenarios)) {
    if (entry.path().extension() != ".toml") continue;
    EXPECT_THAT(doubts_about(load_run_config(entry.path())), IsEmpty()) << entry.path();
  }
}

TEST(Doubts, ArePlacedWhereNothingWouldBeLearned) {
  RunConfig config;
  config.dqn[0].steps = 100'000;
  config.dqn[0].epsilon_steps = 1000;
  config.dqn[0].minimum_size = 100'000;
  EXPECT_THAT(doubts_about(config), ElementsAre(AllOf(HasSubstr("the MoP would learn nothing"),
                                                      HasSubstr("mop.minimum_size = 100000"))));
  config.dqn[0].minimum_size = 99'999;
  EXPECT_THAT(doubts_about(config), IsEmpty());
}

TEST(Doubts, NameWhatNeverComes) {
  RunConfig config;
  config.dqn[1].steps = 30'000;
  config.dqn[1].minimum_size = 1000;
  config.dqn[1].epsilon_steps = 30'001;
  config.dqn[1].annealing_steps = 30'002;
  config.schedule.selection_every_steps = 30'003;
  config.schedule.checkpoint_every_steps = 10'000'000;
  config.simulation.episode_steps = 1000;
  config.evaluation.steps = 999;
  config.traffic.blind_rate_per_s = 0.1;
  config.traffic.blind_duration_s = 0.0;
  const auto doubts = doubts_about(config);
  for (const char* key :
       {"bp.epsilon_steps = 30001", "bp.annealing_steps = 30002",
        "schedule.selection_every_steps = 30003", "evaluation.steps = 999",
        "schedule.checkpoint_every_steps = 10000000", "traffic.blind_duration_s = 0"}) {
    EXPECT_THAT(doubts, Contains(HasSubstr(key)));
  }
  EXPECT_EQ(doubts.size(), 6u);
  config = {};
  config.schedule.steps_per_round = 60'000;
  EXPECT_THAT(doubts_about(config), Contains(HasSubstr("weights hardly ever get to the actors")));
}

}  // namespace
}  // namespace corridor
