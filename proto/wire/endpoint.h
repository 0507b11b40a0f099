// SPDX-License-Identifier: Apache-2.0
// Requests and replies between processes: ordered, exactly once, with deadlines and bounds. The
// only user of ZeroMQ. Bodies are opaque bytes here.
//
// Each object belongs to one thread and starts no thread of its own but ZeroMQ's. Nothing blocks
// longer than it was told to.
//
// Of all processes of one role and index, the server serves the one of the greatest incarnation. It
// refuses the others, whatever of theirs arrives and when, and a refused process ends with the
// reason: two that live at a time do not take turns.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "proto/settings/limits.h"
#include "proto/system/clock.h"
#include "proto/wire/bytes.h"
#include "proto/wire/codec.h"
#include "proto/wire/messages.h"

namespace corridor {

using Duration = std::chrono::milliseconds;

// Where a server listens: "ipc://@name" (abstract Unix socket: no file, gone with its process) or
// "tcp://host:port".
using Address = std::string;

// Who a client is.
struct ClientIdentity {
  std::string run_id;
  Role role = Role::kActor;
  std::uint32_t index = 0;
  std::uint64_t incarnation = 0;  // proto/system/identity.h
};

struct ClientLimits {
  Duration resend_after{1000};  // an unanswered request is sent again
  // A server that says nothing for so long is lost, from the start on. Time that the client spends
  // outside `receive` counts for one resend_after at most.
  Duration peer_timeout{30'000};
  std::size_t window = 8;  // requests without an answer
};

// One client's side of one connection.
class Client {
 public:
  // `peer` names the server in messages ("replay server"). Connects in the background. With a
  // clock that stands still, `receive` is to be called without patience.
  Client(Address server, std::string peer, ClientIdentity identity, ClientLimits limits,
         Clock clock = steady_now);
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  // Sends a request; returns its sequence number. At most `window` may be unanswered (CHECK).
  std::uint64_t send(Body body);

  // The answer to the oldest unanswered request, or nothing when `patience` is over or a signal
  // comes first. Sends again what needs it. Throws Failure when the peer is lost, refuses, or
  // answers nonsense.
  std::optional<Body> receive(Duration patience);

  std::size_t unanswered() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

struct IncomingRequest : Header {
  Body body;
};

struct ServerLimits {
  std::size_t window = 8;                         // answers remembered for each client
  std::size_t clients = 4096;                     // known at a time; further ones are refused
  std::size_t message_bytes = 2 * kDataBytesMax;  // larger ones close their connection
};

// The serving side: any number of clients.
class Server {
 public:
  // Binds. Throws Failure when the address is in use or no address, with what to do about it.
  Server(const Address& address, std::string run_id, ServerLimits limits = {});
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  // The next new request, or nothing when `patience` is over or a signal comes first. Repeated
  // requests are answered here; foreign protocols, runs and lesser incarnations are refused here;
  // anything malformed is dropped and counted. Requests of one client come in their order, each
  // once. A client's new incarnation starts again at 1 and makes the old one's unanswered requests
  // void; one whose first request is another is refused: it spoke to this server's predecessor.
  std::optional<IncomingRequest> receive(Duration patience);

  // Answers a request of `receive`, now or later, in any order. An answer to a client that has
  // gone, or has a new incarnation since, is dropped.
  void reply(const IncomingRequest& to, Body body);

  // Tells the client that its request is impossible; it ends with this text (cut off at
  // kRefusalBytesMax).
  void refuse(const IncomingRequest& request, const std::string& text);

  // Messages dropped or refused since they were malformed, foreign or outdated.
  std::uint64_t dropped() const;

  // Counts a request whose body `receive`'s caller could not decode, and refuses it.
  void reject_malformed(const IncomingRequest& request, const std::string& reason);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace corridor
