// SPDX-License-Identifier: Apache-2.0
// The replay server without its sockets: what each request does and what answers it
// (proto/wire/wire.capnp). A function of the requests and, for each client, of their order: how the
// actors' requests fall between the learner's changes no batch.
//
// A block is open from its OpenBlock's answer to the next OpenBlock or Save. At the first round of
// a phase the store starts afresh, with that phase's settings and row layout. What is malformed or
// impossible is refused before it changes anything. One thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <future>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "proto/settings/schedule.h"
#include "proto/settings/settings.h"
#include "proto/wire/endpoint.h"
#include "proto/wire/messages.h"
#include "replay/admission.h"
#include "replay/snapshot.h"
#include "replay/store.h"

namespace corridor::replay {

// The client cannot go on with such a request; one line for people.
struct Refused {
  std::string text;
};
// The request, an OpenBlock, is answered by a later `try_open`.
struct Waiting {};

// The answer to a Step: a Batch, encoded where its rows were gathered.
struct EncodedBatch {
  Body body;
};

using Outcome = std::variant<ReplayReply, EncodedBatch, Refused, Waiting>;

class ReplayService {
 public:
  // At the start of a run.
  explicit ReplayService(const RunConfig& config);

  // One request of `client`. Requests of one client come in the order in which it sent them.
  Outcome handle(ClientId client, ReplayRequest request);

  // Opens the block that the learner waits for, once every actor's chunk of the round is there:
  // the answer to the newest OpenBlock. Nothing when none waits or a chunk is missing. To be called
  // after every `handle`.
  std::optional<Opened> try_open();

  // The actors that the waiting OpenBlock waits for, ascending; empty when none waits.
  std::vector<std::uint32_t> awaited() const;
  // Chunks of rounds < next_round() are in the store.
  std::uint64_t next_round() const { return admission_.next_round(); }

  // Named values (proto/run/metrics.h) as of the last block; equal in equal runs.
  std::vector<std::pair<std::string, double>> metrics() const;

  // All of rounds < next_round(), nothing parked, but for rows that `previous` (a checkpoint of
  // this run; empty: none) has. Equal states give equal heads and rows. Throws Failure.
  Snapshot snapshot(const std::filesystem::path& previous) const;
  // From a checkpoint: goes on as the one that wrote it did. Throws Failure naming the file.
  void load(const std::filesystem::path& checkpoint);
  // Its replay.safetensors alone: all but the rows.
  void load_head(const TensorFile& head, const std::string& name);

 private:
  Outcome answer(ClientId client, const Join& request);
  Outcome answer(ClientId client, Insert&& request);
  Outcome answer(ClientId client, const OpenBlock& request);
  Outcome answer(ClientId client, const Step& request);
  Outcome answer(ClientId client, const Save& request);

  RowLayout layout(Phase phase) const { return {config_.shape(phase).observations}; }
  // An empty store.
  void begin(Phase phase, std::uint64_t first_key);

  RunConfig config_;
  Schedule schedule_;
  Admission admission_;
  Phase phase_ = Phase::kMop;  // of the store
  Store store_;
  bool waits_ = false;              // an OpenBlock for next_round()
  bool open_ = false;               // block next_round() - 1 is
  std::filesystem::path saved_in_;  // the newest checkpoint asked for
  std::future<void> saving_;        // the thread that writes it; none once it is done
};

}  // namespace corridor::replay
