// SPDX-License-Identifier: Apache-2.0
#include "cluster/watch/training_monitor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/run/metrics.h"
#include "proto/system/files.h"
#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

using testing::HasSubstr;

class Monitored : public testing::Test {
 protected:
  TrainingMonitor monitor(std::uint64_t rounds_done = 0) {
    return {schedule_, 1, directory_, rounds_done, 2, 0.0};
  }
  // A block of the learner's, as its metrics file gets it.
  void learn(std::uint64_t round) {
    const auto rounds = static_cast<std::int64_t>(round + 1);
    MetricsWriter(directory_.metrics(kLearnerName))
        .write("MoP", round, rounds * schedule_.steps_per_round(), {{metric::kTdLoss, 0.25}});
  }
  std::uintmax_t event_bytes() const {
    std::uintmax_t bytes = 0;
    for (const auto& file : std::filesystem::directory_iterator(directory_.tensorboard())) {
      bytes += file.file_size();
    }
    return bytes;
  }

  testing_support::TemporaryDirectory temporary_;
  RunDirectory directory_ = RunDirectory::create(temporary_.path() / "run");
  const Schedule schedule_{RunConfig{}};
};

TEST_F(Monitored, WhatTheLearnerWritesIsProgressAndAnEvent) {
  testing::internal::CaptureStdout();
  {
    TrainingMonitor shown = monitor();
    const std::uintmax_t before = event_bytes();
    learn(3);
    shown.tick(1.0);
    EXPECT_EQ(shown.steps_done(), 4 * schedule_.steps_per_round());
    EXPECT_GT(event_bytes(), before);
  }
  EXPECT_THAT(testing::internal::GetCapturedStdout(), HasSubstr("2,048 of"));
}

TEST_F(Monitored, AfterARestartItGoesOnFromTheRoundsDone) {
  testing::internal::CaptureStdout();
  {
    TrainingMonitor shown = monitor(5);
    EXPECT_EQ(shown.steps_done(), 5 * schedule_.steps_per_round());
    learn(7);
    shown.restarted(6, 1.0);
    learn(6);
    shown.tick(20.0);
    EXPECT_EQ(shown.steps_done(), 7 * schedule_.steps_per_round());
  }
  testing::internal::GetCapturedStdout();
}

TEST_F(Monitored, ATrainingGoesOnWhereItsEventsCannotBeWritten) {
  write_file(directory_.tensorboard(), "no folder");
  testing::internal::CaptureStdout();
  {
    TrainingMonitor shown = monitor();
    learn(0);
    shown.tick(1.0);
    EXPECT_EQ(shown.steps_done(), schedule_.steps_per_round());
  }
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              HasSubstr("goes on without events for TensorBoard"));
}

}  // namespace
}  // namespace corridor::cluster
