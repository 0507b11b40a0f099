// SPDX-License-Identifier: Apache-2.0
// Values <-> bytes. The only user of Cap'n Proto.
//
// Decoders take bytes from anywhere: alignment does not matter, nothing larger than a small
// multiple of the input is allocated, and whatever is not a well-formed message within the limits
// of proto/wire/wire.capnp (also: a row count that does not fit the row length, a key without a
// priority) gives Malformed, with the reason in one line. Cost: one copy each way.
#pragma once

#include <optional>
#include <span>
#include <stdexcept>

#include "proto/wire/bytes.h"
#include "proto/wire/messages.h"

namespace corridor {

// The sender's fault: a server drops and counts the message, a client gives up (Failure).
class Malformed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

Bytes encode(const Header& header);
Bytes encode(const ReplayRequest& request);
Bytes encode(const ReplayReply& reply);
Bytes encode(const LearnerRequest& request);
Bytes encode(const LearnerReply& reply);

Header decode_header(ByteView bytes);
ReplayRequest decode_replay_request(ByteView bytes);
ReplayReply decode_replay_reply(ByteView bytes);  // but for a Batch: decode_batch
LearnerRequest decode_learner_request(ByteView bytes);
LearnerReply decode_learner_reply(ByteView bytes);

// The reply that is a Batch, without a copy at either end.

// To be filled in the bytes that will be sent: spans of uninitialised memory in `body`.
struct BatchToFill {
  std::span<float> rows;  // whole rows of `observations`
  std::span<std::uint64_t> keys;
  std::span<float> weights;
  Body body;
};
BatchToFill batch_to_fill(std::uint32_t observations, std::size_t rows);

// Looked at in the bytes that came: views into `body`.
struct ReceivedBatch {
  std::uint32_t observations = 0;
  std::span<const float> rows;
  std::span<const std::uint64_t> keys;
  std::span<const float> weights;
  Body body;
};
// Nothing when the reply is another one.
std::optional<ReceivedBatch> decode_batch(Body body);

}  // namespace corridor
