// SPDX-License-Identifier: Apache-2.0
// The learner's side of the replay server: opens blocks, draws a block's batches and returns their
// priorities, asks for checkpoints. One thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "proto/system/time_account.h"
#include "proto/wire/codec.h"
#include "proto/wire/endpoint.h"
#include "proto/wire/messages.h"

namespace corridor::learner {

// A Step draws batches of about so many rows at once: a message each would cost as much as the
// training on a batch of 64.
inline constexpr std::uint32_t kRowsPerStep = 512;

// Steps under way at a time. Step i + kDepth is drawn with the priorities of steps 0 .. i, whatever
// the timing, and the learner trains on one step's batches while the server draws the next.
inline constexpr std::uint32_t kDepth = 2;

// A look whether a message has come, where there is nothing else to do.
inline constexpr Duration kGlance{1};

struct Block {
  std::uint32_t batches = 0;  // as granted
  std::uint32_t batch_size = 0;
  double importance_exponent = 0.0;
};

// Every function throws Failure when the server is lost, refuses, or answers something else.
class ReplayClient {
 public:
  // `between` is called after every step of a block, and about every millisecond while an answer is
  // awaited. It, waiting and transport are charged to `time`.
  ReplayClient(Client& client, TimeAccount& time, std::function<void()> between);

  // The first message. Throws Failure unless the server goes on with block `next_round`.
  void join(std::uint64_t next_round);

  // Opens a block once all its chunks are there. Nothing when `give_up` says so first: the request
  // then stands unanswered, and this object and its client are good for nothing more.
  std::optional<Opened> open_block(std::uint64_t round, const std::function<bool()>& give_up);

  // Draws the block's batches and trains on one after the other; `train` returns a batch's new
  // priorities, one a row. Batch b of a step's n has its rows b, b + n, b + 2n ...: each is a
  // stratified draw of its own. At its return the server has all priorities.
  void run_block(const Block& block, const std::function<std::vector<float>(const Batch&)>& train);

  // Between blocks: has the replay's part of a checkpoint written; whether it is complete. To be
  // called again, between later blocks, until it is. `previous`: the newest checkpoint, or empty.
  bool save(const std::filesystem::path& directory, const std::filesystem::path& previous);

 private:
  void send(const ReplayRequest& request);
  void do_between();
  // One look at the socket.
  std::optional<Body> glance(TimePart waiting);
  Body receive();
  ReceivedBatch receive_batch(std::size_t rows);

  Client& client_;
  TimeAccount& time_;
  std::function<void()> between_;
  Batch batch_;  // scratch of run_block
};

}  // namespace corridor::learner
