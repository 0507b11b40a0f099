// SPDX-License-Identifier: Apache-2.0
#include "replay/serve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "proto/base/failure.h"
#include "proto/base/json.h"
#include "proto/run/metrics.h"
#include "proto/system/log.h"
#include "proto/system/time_account.h"
#include "proto/wire/codec.h"
#include "tests/replay/small_run.h"
#include "tests/support/batches.h"
#include "tests/support/manual_clock.h"
#include "tests/support/temporary_directory.h"

namespace corridor::replay {
namespace {

using testing_support::decoded_batch;

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* kRunId = "00112233445566778899aabbccddeeff";
constexpr std::uint64_t kManyRounds = 33;

// One that lasts until the first metrics are due.
RunConfig longer_config() {
  RunConfig config = small_config();
  config.dqn[0].steps = 20 * kActors * static_cast<std::int64_t>(kManyRounds);
  return config;
}

// A chunk of the MoP phase, whatever its round.
Insert mop_chunk(std::uint64_t round, std::uint32_t index) {
  Insert result = chunk(round % kMopRounds, index);
  result.round = round;
  return result;
}

// A server on a thread of its own, with an address of its own.
class ServeTest : public testing::Test {
 protected:
  ServeTest() {
    address_ =
        fmt::format("ipc://@corridor-serve-test-{}-{}", getpid(), directory_.filename().string());
    thread_ = std::thread([this] {
      const RunConfig config = longer_config();
      ReplayService service(config);
      MetricsWriter metrics(directory_ / "replay.jsonl");
      Server server(address_, kRunId);
      serve(server, service, metrics, config,
            {[this] { return stop_.load(); }, [this] { ++delays_; }, time_.clock()});
    });
  }
  ~ServeTest() override {
    stop_ = true;
    thread_.join();
  }

  Client connect(Role role, std::uint32_t index, std::uint64_t incarnation = 1) const {
    return Client(address_, "replay server", {kRunId, role, index, incarnation}, {});
  }

  static Body receive_body(Client& client) {
    const std::optional<Body> bytes = client.receive(Duration{20'000});
    if (!bytes) throw Failure("no answer");
    return *bytes;
  }
  static ReplayReply receive(Client& client) { return decode_replay_reply(receive_body(client)); }
  static ReplayReply ask(Client& client, const ReplayRequest& request) {
    client.send(encode(request));
    return receive(client);
  }
  static std::string refusal(Client& client, Bytes body) {
    try {
      client.send(std::move(body));
      client.receive(Duration{20'000});
    } catch (const Failure& failure) {
      return failure.what();
    }
    return "not refused";
  }

  testing_support::TemporaryDirectory temporary_;
  fs::path directory_ = temporary_.path();
  Address address_;
  std::atomic<bool> stop_ = false;
  std::atomic<std::uint64_t> delays_ = 0;
  testing_support::ManualClock time_;
  std::thread thread_;
};

TEST_F(ServeTest, ClientsGetWhatTheServiceAloneWouldAnswer) {
  ReplayService alone(longer_config());
  Client learner = connect(Role::kLearner, 0);
  std::vector<std::unique_ptr<Client>> actors;
  for (std::uint32_t i = 0; i < kActors; ++i) {
    actors.push_back(std::make_unique<Client>(
        address_, "replay server", ClientIdentity{kRunId, Role::kActor, i, 1}, ClientLimits{}));
  }
  for (std::uint64_t round = 0; round < kManyRounds; ++round) {
    // Wanted before the chunks are there; these come in an order of their own each round.
    learner.send(encode(ReplayRequest{OpenBlock{round}}));
    for (std::uint32_t i = 0; i < kActors; ++i) {
      const auto index = static_cast<std::uint32_t>((round + 2 * i) % kActors);
      EXPECT_EQ(ask(*actors[index], mop_chunk(round, index)), ReplayReply(Inserted{}));
      alone.handle({Role::kActor, i}, mop_chunk(round, i));
    }
    alone.handle({Role::kLearner, 0}, OpenBlock{round});
    const Opened opened = alone.try_open().value();
    ASSERT_EQ(receive(learner), ReplayReply(opened));
    // Four steps under way at once.
    const std::uint32_t steps = std::min(4U, opened.batches);
    const Step step{{}, {}, 8, 0.4};
    for (std::uint32_t i = 0; i < steps; ++i) learner.send(encode(ReplayRequest{step}));
    for (std::uint32_t i = 0; i < steps; ++i) {
      const Outcome outcome = alone.handle({Role::kLearner, 0}, step);
      ASSERT_EQ(decoded_batch(receive_body(learner)),
                decoded_batch(std::get<EncodedBatch>(outcome).body));
    }
  }

  EXPECT_EQ(delays_, kManyRounds * (kActors + 1)) << "once a chunk and a block";
  std::ifstream file(directory_ / "replay.jsonl");
  const Json line = Json::parse(file);
  EXPECT_EQ(line.at("round"), 31);
  EXPECT_EQ(line.at("step"), 32 * 20 * kActors);
  EXPECT_EQ(line.at(metric::kReplaySize), 150);
  for (const std::string& name : std::vector<std::string>{
           metric::kReplayInserted, metric::kReplaySampled, metric::kSamplesPerInsert,
           time_metric(TimePart::kWaitForActors), time_metric(TimePart::kWaitForLearner),
           time_metric(TimePart::kInsert), time_metric(TimePart::kSample),
           time_metric(TimePart::kTransport), kWallTimeMetric, kCpuTimeMetric}) {
    EXPECT_GT(line.at(name), 0.0) << name;
  }
}

TEST_F(ServeTest, SaysWhomItWaitsForWhenABlockStaysUnopenedForLong) {
  start_log("test");
  testing::internal::CaptureStderr();
  Client learner = connect(Role::kLearner, 0);
  learner.send(encode(ReplayRequest{OpenBlock{0}}));
  while (delays_ == 0) learner.receive(Duration{1});
  Client actor = connect(Role::kActor, 1);
  ask(actor, Join{});
  ask(actor, mop_chunk(0, 1));
  time_.advance(std::chrono::seconds(6));
  // Each is answered in a turn of its own, at whose end the server looks at the clock.
  ask(actor, Join{});
  ask(actor, Join{});
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              HasSubstr("block 0 waits for the chunks of actors 0 2"));
}

TEST_F(ServeTest, NonsenseIsRefusedAndTheServerGoesOn) {
  for (std::uint64_t attempt = 1; attempt <= 50; ++attempt) {
    Bytes noise(random_below(4000, attempt, Purpose::kBootstrap, {0}));
    for (std::size_t i = 0; i < noise.size(); ++i) {
      noise[i] = static_cast<std::byte>(random_below(256, attempt, Purpose::kBootstrap, {1, i}));
    }
    Client noisy = connect(Role::kActor, 0, attempt);
    EXPECT_THAT(refusal(noisy, noise), HasSubstr("malformed"));
  }
  Client stranger = connect(Role::kActor, kActors);
  EXPECT_THAT(refusal(stranger, encode(ReplayRequest{Join{}})), HasSubstr("run.actors"));
  Client hasty = connect(Role::kLearner, 0);
  EXPECT_THAT(refusal(hasty, encode(ReplayRequest{Step{}})), HasSubstr("outside an open block"));

  Client good = connect(Role::kActor, 1);
  EXPECT_EQ(ask(good, Join{}), ReplayReply(Joined{}));
}

}  // namespace
}  // namespace corridor::replay
