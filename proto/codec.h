// Values <-> bytes. The only user of Cap'n Proto.
//
// Decoders take bytes from anywhere: alignment does not matter, nothing larger than a small
// multiple of the input is allocated, and whatever is not a well-formed message within the limits
// of proto/wire.capnp (also: a row count that does not fit the row length, a key without a priority)
// gives Malformed, with the reason in one line. Cost: one copy each way.
#pragma once

#include <span>
#include <stdexcept>

#include "proto/messages.h"

namespace corridor {

// The sender's fault: a server drops and counts the message, a client gives up (Failure).
class Malformed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

using ByteView = std::span<const std::byte>;

Bytes encode(const Header& header);
Bytes encode(const ReplayRequest& request);
Bytes encode(const ReplayReply& reply);
Bytes encode(const LearnerRequest& request);
Bytes encode(const LearnerReply& reply);

Header decode_header(ByteView bytes);
ReplayRequest decode_replay_request(ByteView bytes);
ReplayReply decode_replay_reply(ByteView bytes);
LearnerRequest decode_learner_request(ByteView bytes);
LearnerReply decode_learner_reply(ByteView bytes);

}  // namespace corridor
