#include "learner/replay_client.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <thread>

#include "proto/codec.h"
#include "proto/failure.h"
#include "tests/learner/small_run.h"

namespace corridor::learner {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// A replay server that notes what it is asked and answers by a script.
class ScriptedServer {
 public:
  explicit ScriptedServer(std::function<std::optional<ReplayReply>(const ReplayRequest&)> script)
      : script_(std::move(script)), thread_([this] { serve(); }) {}
  ~ScriptedServer() {
    end_ = true;
    thread_.join();
  }
  const std::string& address() const { return address_; }
  // Once the server has ended.
  const std::vector<ReplayRequest>& end() {
    end_ = true;
    thread_.join();
    thread_ = std::thread([] {});
    return requests_;
  }

 private:
  void serve() {
    Server server(address_, kRunId);
    while (!end_) {
      const auto request = server.receive(Duration{5});
      if (!request) continue;
      requests_.push_back(decode_replay_request(request->body));
      if (const auto reply = script_(requests_.back())) server.reply(*request, encode(*reply));
    }
  }

  const std::string address_ = fresh_address("scripted");
  std::function<std::optional<ReplayReply>(const ReplayRequest&)> script_;
  std::atomic<bool> end_ = false;
  std::vector<ReplayRequest> requests_;
  std::thread thread_;
};

struct Connection {
  explicit Connection(const ScriptedServer& server)
      : client(server.address(), "replay server", {kRunId, Role::kLearner, 0, fresh_incarnation()},
               {}) {}
  Client client;
  int waits = 0;
  ReplayClient replay{client, [this] { ++waits; }};
};

// Batch n has the keys 10 n, 10 n + 1, ...
std::function<std::optional<ReplayReply>(const ReplayRequest&)> batches() {
  return [number = 0](const ReplayRequest& request) mutable -> std::optional<ReplayReply> {
    const auto& step = std::get<Step>(request);
    Batch batch;
    batch.observations = 1;
    for (std::uint32_t i = 0; i < step.count; ++i) {
      batch.keys.push_back(static_cast<std::uint64_t>(10 * number) + i);
      batch.weights.push_back(1.0f);
      batch.rows.insert(batch.rows.end(), {0.0f, 0.0f, 0.0f, 0.0f, 0.0f});
    }
    if (step.count > 0) ++number;
    return batch;
  };
}

std::vector<float> key_as_priority(const Batch& batch) {
  return {batch.keys.begin(), batch.keys.end()};
}

TEST(ReplayClient, SendsABatchsPrioritiesWithTheStepSoManyLater) {
  ScriptedServer server(batches());
  Connection connection(server);
  std::vector<std::uint64_t> trained;
  constexpr std::uint32_t kBatches = kDepth + 2;
  connection.replay.run_block({kBatches, 2, 0.5}, [&](const Batch& batch) {
    trained.push_back(batch.keys[0]);
    return key_as_priority(batch);
  });
  ASSERT_EQ(trained.size(), kBatches);
  EXPECT_EQ(connection.client.unanswered(), 0u);
  std::vector<ReplayRequest> expected(kDepth, Step{{}, {}, 2, 0.5});
  for (std::uint32_t i = 0; i < kBatches; ++i) {
    EXPECT_EQ(trained[i], 10 * i);
    const std::uint64_t key = 10 * i;
    expected.push_back(Step{{key, key + 1},
                            {static_cast<float>(key), static_cast<float>(key + 1)},
                            i + kDepth < kBatches ? 2u : 0u,
                            0.5});
  }
  EXPECT_EQ(server.end(), expected);
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
  ScriptedServer server([](const ReplayRequest&) { return Batch{}; });
  Connection connection(server);
  try {
    connection.replay.run_block({1, 2, 0.5}, key_as_priority);
    FAIL() << "no Failure";
  } catch (const Failure& failure) {
    EXPECT_THAT(failure.what(), HasSubstr("sent 0 keys and 0 weights, 2 rows"));
  }
}

TEST(ReplayClient, RefusesAnAnswerToAnotherQuestion) {
  ScriptedServer server([](const ReplayRequest&) { return Inserted{}; });
  Connection connection(server);
  EXPECT_THROW(connection.replay.save("/nowhere"), Failure);
}

}  // namespace
}  // namespace corridor::learner
