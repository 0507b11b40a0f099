// SPDX-License-Identifier: Apache-2.0
#include "learner/replay_client.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "proto/base/failure.h"
#include "proto/wire/codec.h"
#include "proto/wire/connect.h"

namespace corridor::learner {
namespace {

constexpr const char* kPeer = "replay server";

// `batch` becomes rows first, first + n, first + 2n ... of `drawn`.
void every_nth(const ReceivedBatch& drawn, std::size_t first, std::size_t n, Batch& batch) {
  const std::size_t stride = drawn.rows.size() / drawn.keys.size();
  batch.observations = drawn.observations;
  batch.rows.clear();
  batch.keys.clear();
  batch.weights.clear();
  for (std::size_t row = first; row < drawn.keys.size(); row += n) {
    const auto from = drawn.rows.begin() + static_cast<std::ptrdiff_t>(row * stride);
    batch.rows.insert(batch.rows.end(), from, from + static_cast<std::ptrdiff_t>(stride));
    batch.keys.push_back(drawn.keys[row]);
    batch.weights.push_back(drawn.weights[row]);
  }
}

}  // namespace

ReplayClient::ReplayClient(Client& client, TimeAccount& time, std::function<void()> between)
    : client_(client), time_(time), between_(std::move(between)) {}

void ReplayClient::send(const ReplayRequest& request) { client_.send(encode(request)); }

std::optional<Body> ReplayClient::glance(TimePart waiting) {
  std::optional<Body> body = client_.receive(kGlance);
  time_.charge(waiting);
  if (body) return body;
  do_between();
  return std::nullopt;
}

void ReplayClient::do_between() {
  between_();
  time_.charge(TimePart::kPublish);
}

Body ReplayClient::receive() {
  time_.charge(TimePart::kTransport);
  while (true) {
    // The client itself gives up on a server that is lost.
    if (const auto body = glance(TimePart::kWaitForReplay)) return *body;
  }
}

void ReplayClient::join(std::uint64_t next_round) {
  send(Join{});
  const std::uint64_t servers = expect<Joined>(receive(), decode_replay_reply, kPeer).next_round;
  if (servers == next_round) return;
  throw Failure(
      "the replay server goes on with round {}, the learner with round {}: both must start from "
      "the same checkpoint; end all processes and resume the run",
      servers, next_round);
}

std::optional<Opened> ReplayClient::open_block(std::uint64_t round,
                                               const std::function<bool()>& give_up) {
  send(OpenBlock{round});
  time_.charge(TimePart::kTransport);
  while (!give_up()) {
    if (const auto body = glance(TimePart::kWaitForActors)) {
      return expect<Opened>(*body, decode_replay_reply, kPeer);
    }
  }
  return std::nullopt;
}

ReceivedBatch ReplayClient::receive_batch(std::size_t rows) {
  const auto decode = [](const Body& body) -> std::variant<std::monostate, ReceivedBatch> {
    if (auto batch = decode_batch(body)) return *std::move(batch);
    return {};
  };
  ReceivedBatch batch = expect<ReceivedBatch>(receive(), decode, kPeer);
  if (batch.keys.size() != rows || batch.weights.size() != rows) {
    throw Failure("the replay server sent {} keys and {} weights, {} rows were asked for",
                  batch.keys.size(), batch.weights.size(), rows);
  }
  return batch;
}

void ReplayClient::run_block(const Block& block,
                             const std::function<std::vector<float>(const Batch&)>& train) {
  const std::uint32_t together = std::max(1u, kRowsPerStep / block.batch_size);
  const std::uint32_t steps = (block.batches + together - 1) / together;
  // Steps past the last one draw nothing: they bring priorities only.
  const auto batches_of = [&](std::uint32_t step) {
    return step < steps ? std::min(together, block.batches - step * together) : 0;
  };
  const auto step = [&](std::uint32_t index) {
    return Step{{}, {}, batches_of(index) * block.batch_size, block.importance_exponent};
  };
  for (std::uint32_t i = 0; i < std::min(steps, kDepth); ++i) send(step(i));
  for (std::uint32_t i = 0; i < steps; ++i) {
    const ReceivedBatch drawn = receive_batch(batches_of(i) * block.batch_size);
    Step next = step(i + kDepth);
    next.priorities.resize(drawn.keys.size());
    for (std::uint32_t b = 0; b < batches_of(i); ++b) {
      every_nth(drawn, b, batches_of(i), batch_);
      const std::vector<float> priorities = train(batch_);
      CORRIDOR_CHECK(priorities.size() == block.batch_size, "{} priorities for {} rows",
                     priorities.size(), block.batch_size);
      for (std::size_t row = 0; row < priorities.size(); ++row) {
        next.priorities[b + row * batches_of(i)] = priorities[row];
      }
    }
    next.keys.assign(drawn.keys.begin(), drawn.keys.end());
    send(next);
    time_.charge(TimePart::kTransport);
    do_between();
  }
  for (std::uint32_t i = 0; i < std::min(steps, kDepth); ++i) receive_batch(0);
}

bool ReplayClient::save(const std::filesystem::path& directory,
                        const std::filesystem::path& previous) {
  send(Save{directory.string(), previous.string()});
  return expect<Saved>(receive(), decode_replay_reply, kPeer).complete;
}

}  // namespace corridor::learner
