#include "learner/replay_client.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "proto/codec.h"
#include "proto/failure.h"

namespace corridor::learner {
namespace {

constexpr Duration kGlance{1};

template <typename Reply>
Reply expect(const Bytes& body) {
  try {
    ReplayReply reply = decode_replay_reply(body);
    if (Reply* expected = std::get_if<Reply>(&reply)) return std::move(*expected);
  } catch (const Malformed& malformed) {
    throw Failure("the replay server's answer is malformed: {}", malformed.what());
  }
  throw Failure(
      "the replay server answered another question: do all processes run the same build?");
}

}  // namespace

ReplayClient::ReplayClient(Client& client, std::function<void()> on_wait)
    : client_(client), on_wait_(std::move(on_wait)) {}

void ReplayClient::send(const ReplayRequest& request) { client_.send(encode(request)); }

template <typename Reply>
Reply ReplayClient::receive() {
  while (true) {
    // The client itself gives up on a server that is lost.
    if (const std::optional<Bytes> body = client_.receive(kGlance)) return expect<Reply>(*body);
    on_wait_();
  }
}

void ReplayClient::join(std::uint64_t next_round) {
  send(Join{});
  const std::uint64_t servers = receive<Joined>().next_round;
  if (servers == next_round) return;
  throw Failure(
      "the replay server goes on with round {}, the learner with round {}: both must start from "
      "the same checkpoint; end all processes and resume the run",
      servers, next_round);
}

std::optional<Opened> ReplayClient::open_block(std::uint64_t round,
                                               const std::function<bool()>& give_up) {
  send(OpenBlock{round});
  while (!give_up()) {
    if (const std::optional<Bytes> body = client_.receive(kGlance)) return expect<Opened>(*body);
    on_wait_();
  }
  return std::nullopt;
}

Batch ReplayClient::receive_batch(std::size_t rows) {
  const auto start = std::chrono::steady_clock::now();
  Batch batch = receive<Batch>();
  waited_s_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (batch.keys.size() != rows || batch.weights.size() != rows) {
    throw Failure("the replay server sent {} keys and {} weights, {} rows were asked for",
                  batch.keys.size(), batch.weights.size(), rows);
  }
  return batch;
}

void ReplayClient::run_block(const Block& block,
                             const std::function<std::vector<float>(const Batch&)>& train) {
  const auto ahead = std::min(block.batches, static_cast<std::uint32_t>(kDepth));
  for (std::uint32_t i = 0; i < ahead; ++i) {
    send(Step{{}, {}, block.batch_size, block.importance_exponent});
  }
  for (std::uint32_t i = 0; i < block.batches; ++i) {
    Batch batch = receive_batch(block.batch_size);
    std::vector<float> priorities = train(batch);
    CORRIDOR_CHECK(priorities.size() == batch.keys.size(), "{} priorities for {} keys",
                   priorities.size(), batch.keys.size());
    // The last steps bring priorities only.
    const std::uint32_t count = i + kDepth < block.batches ? block.batch_size : 0;
    send(Step{std::move(batch.keys), std::move(priorities), count, block.importance_exponent});
  }
  for (std::uint32_t i = 0; i < ahead; ++i) receive_batch(0);
}

void ReplayClient::save(const std::filesystem::path& directory) {
  send(Save{directory.string()});
  receive<Saved>();
}

}  // namespace corridor::learner
