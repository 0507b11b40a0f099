// SPDX-License-Identifier: Apache-2.0
#include "actor/redrive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "actor/evaluation.h"
#include "proto/system/files.h"
#include "tests/support/failure_of.h"
#include "tests/support/fake_world.h"
#include "tests/support/temporary_directory.h"

namespace corridor::actor {
namespace {

using testing::HasSubstr;
using testing_support::FakeWorld;

class Redrive : public testing::Test {
 protected:
  Redrive() {
    config_.simulation.episode_steps = 60;
    for (const NamedNetwork& network : kNetworks) {
      networks_[network.id].assign(config_.parameters(network.id), 0.01f);
    }
  }

  // Of an evaluation with seed 5.
  RecordedEpisode evaluated(const std::string& planner, std::uint64_t index) {
    FakeWorld world(config_);
    evaluate(config_, networks_, {planner, 5, 150}, run_, world, [](std::int64_t) { return true; });
    return read_recorded_episode(run_.episode({planner, 5, index}));
  }
  Redriven redriven(const RecordedEpisode& episode) {
    write_recorded_episode(run_, episode);
    FakeWorld world(config_);
    return redrive(config_, run_.episode(episode.name()), world, {});
  }

  testing_support::TemporaryDirectory temporary_;
  RunDirectory run_ = RunDirectory::create(temporary_.path() / "run");
  RunConfig config_;
  Networks networks_;
};

TEST_F(Redrive, AnEpisodeHasTheSameTrajectory) {
  for (const char* planner : {"rules", "hierarchical", "sumo", "random+rules"}) {
    const RecordedEpisode episode = evaluated(planner, 1);
    const Redriven result = redriven(episode);
    EXPECT_TRUE(result.as_recorded) << planner;
    EXPECT_EQ(record_of(result.summary, 1), episode.summary) << planner;
  }
}

TEST_F(Redrive, AChangedActionChangesTheTrajectory) {
  RecordedEpisode episode = evaluated("rules", 0);
  episode.actions[3] = episode.actions[3] == 0 ? 26 : 0;
  EXPECT_FALSE(redriven(episode).as_recorded);
}

TEST_F(Redrive, WhatIsNoEpisodeOfThisRunIsRefused) {
  FakeWorld world(config_);
  const auto file = temporary_.path() / "file.json";
  const auto refusal = [&] { return failure_of([&] { redrive(config_, file, world, {}); }); };
  EXPECT_THAT(refusal(), HasSubstr("file.json"));
  write_file(file, "{}");
  EXPECT_THAT(refusal(), HasSubstr("file.json is no recorded episode"));
  RecordedEpisode episode = evaluated("rules", 0);
  episode.actions[0] = 255;
  EXPECT_THAT(failure_of([&] { redriven(episode); }), HasSubstr("it is of another run"));
}

}  // namespace
}  // namespace corridor::actor
