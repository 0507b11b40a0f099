// SPDX-License-Identifier: Apache-2.0
#include "learner/replay_client.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <thread>

#include "proto/base/failure.h"
#include "proto/wire/codec.h"
#include "tests/learner/scripted_server.h"
#include "tests/learner/small_run.h"
#include "tests/support/batches.h"

namespace corridor::learner {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Connection {
  explicit Connection(const ScriptedServer& server)
      : client(server.address(), "replay server", {kRunId, Role::kLearner, 0, fresh_incarnation()},
               {}) {}
  Client client;
  int waits = 0;
  TimeAccount time;
  ReplayClient replay{client, time, [this] { ++waits; }};
};

// Keys count on from 0; a row's values are its key.
ScriptedServer::Script batches() {
  return [key = std::uint64_t{0}](const ReplayRequest& request) mutable -> std::optional<Body> {
    Batch batch;
    batch.observations = 1;
    for (std::uint32_t i = 0; i < std::get<Step>(request).count; ++i, ++key) {
      batch.keys.push_back(key);
      batch.weights.push_back(static_cast<float>(key));
      batch.rows.insert(batch.rows.end(), RowLayout{1}.stride(), static_cast<float>(key));
    }
    return testing_support::encoded(batch);
  };
}

constexpr std::uint32_t kBatchSize = 64;
constexpr std::uint32_t kBatchesPerStep = kRowsPerStep / kBatchSize;

std::vector<float> key_as_priority(const Batch& batch) {
  return {batch.keys.begin(), batch.keys.end()};
}

TEST(ReplayClient, SendsAStepsPrioritiesWithTheStepSoManyLater) {
  ScriptedServer server(batches());
  Connection connection(server);
  constexpr std::uint32_t kSteps = kDepth + 2;
  std::size_t trained = 0;
  connection.replay.run_block({kSteps * kBatchesPerStep, kBatchSize, 0.5}, [&](const Batch& batch) {
    ++trained;
    return key_as_priority(batch);
  });
  EXPECT_EQ(trained, kSteps * kBatchesPerStep);
  EXPECT_EQ(connection.client.unanswered(), 0u);
  std::vector<ReplayRequest> expected(kDepth, Step{{}, {}, kRowsPerStep, 0.5});
  for (std::uint32_t i = 0; i < kSteps; ++i) {
    Step step{{}, {}, i + kDepth < kSteps ? kRowsPerStep : 0u, 0.5};
    for (std::uint32_t row = 0; row < kRowsPerStep; ++row) {
      step.keys.push_back(i * kRowsPerStep + row);
    }
    step.priorities.assign(step.keys.begin(), step.keys.end());
    expected.push_back(step);
  }
  EXPECT_EQ(server.end(), expected);
}

TEST(ReplayClient, DealsAStepsRowsOutToItsBatches) {
  ScriptedServer server(batches());
  Connection connection(server);
  // A whole step, and one of 3 batches.
  std::vector<Batch> trained;
  connection.replay.run_block({kBatchesPerStep + 3, kBatchSize, 0.5}, [&](const Batch& batch) {
    trained.push_back(batch);
    return key_as_priority(batch);
  });
  ASSERT_EQ(trained.size(), kBatchesPerStep + 3);
  for (std::uint32_t i = 0; i < trained.size(); ++i) {
    const bool last = i >= kBatchesPerStep;
    const Batch& batch = trained[i];
    ASSERT_EQ(batch.keys.size(), kBatchSize);
    for (std::uint32_t row = 0; row < kBatchSize; ++row) {
      const std::uint64_t key =
          last ? kRowsPerStep + (i - kBatchesPerStep) + 3 * row : i + kBatchesPerStep * row;
      EXPECT_EQ(batch.keys[row], key);
      EXPECT_EQ(batch.weights[row], static_cast<float>(key));
      EXPECT_EQ(batch.rows[row * RowLayout{1}.stride()], static_cast<float>(key));
    }
    EXPECT_EQ(batch.rows.size(), kBatchSize * RowLayout{1}.stride());
  }
}

TEST(ReplayClient, RunsBlocksOfOneBatchAndOfNone) {
  ScriptedServer server(batches());
  Connection connection(server);
  connection.replay.run_block({0, 2, 0.5}, key_as_priority);
  connection.replay.run_block({1, 2, 0.5}, key_as_priority);
  EXPECT_EQ(server.end(),
            (std::vector<ReplayRequest>{Step{{}, {}, 2, 0.5}, Step{{0, 1}, {0, 1}, 0, 0.5}}));
}

TEST(ReplayClient, GivesUpABlockWhenToldTo) {
  ScriptedServer server([](const ReplayRequest&) { return std::nullopt; });
  Connection connection(server);
  EXPECT_EQ(connection.replay.open_block(3, [&] { return connection.waits == 3; }), std::nullopt);
}

TEST(ReplayClient, RefusesABatchOfAnotherSize) {
  ScriptedServer server([](const ReplayRequest&) { return testing_support::encoded({}); });
  Connection connection(server);
  try {
    connection.replay.run_block({1, 2, 0.5}, key_as_priority);
    FAIL() << "no Failure";
  } catch (const Failure& failure) {
    EXPECT_THAT(failure.what(), HasSubstr("sent 0 keys and 0 weights, 2 rows"));
  }
}

TEST(ReplayClient, RefusesAnAnswerToAnotherQuestion) {
  ScriptedServer server([](const ReplayRequest&) { return Body(encode(ReplayReply(Inserted{}))); });
  Connection connection(server);
  EXPECT_THROW(connection.replay.save("/nowhere", ""), Failure);
}

}  // namespace
}  // namespace corridor::learner
