// SPDX-License-Identifier: Apache-2.0
#include "proto/wire/endpoint.h"

#include <netdb.h>

#include <algorithm>
#include <cerrno>
#include <deque>
#include <map>
#include <vector>
#include <zmq.hpp>

#include "proto/base/failure.h"

namespace corridor {
namespace {

using Frames = std::vector<zmq::message_t>;

// A peer's connection that is silent for so long is made anew (a cut link, a lost host). ZeroMQ's
// threads answer even while their process computes; stopped processes only lose the connection.
constexpr int kHeartbeatEvery_ms = 1000;
constexpr int kHeartbeatTimeout_ms = 10'000;
constexpr int kConnectTimeout_ms = 2000;
constexpr int kReconnectFirst_ms = 10;
constexpr int kReconnectLast_ms = 200;
// A reply to a client: every network of the largest size, and some.
constexpr std::int64_t kReplyBytesMax = (kNetworks.size() + 1) * kDataBytesMax;
// Messages handled within one call before it looks at its deadline, whatever pours in.
constexpr int kHandledAtOnce = 1024;
// A ROUTER's message: routing id, header, body; a DEALER's: header, body.
constexpr std::size_t kServerFrames = 3;
constexpr std::size_t kClientFrames = 2;

// For calls that do not block, so that a signal may not leave a message half sent or read.
template <typename Call>
auto uninterrupted(const Call& call) {
  while (true) {
    try {
      return call();
    } catch (const zmq::error_t& error) {
      if (error.num() != EINTR) throw;
    }
  }
}

// Waits until the socket has something to read; false when a signal came instead.
bool wait_for_message(zmq::socket_t& socket, TimePoint::duration patience) {
  zmq::pollitem_t item{socket.handle(), 0, ZMQ_POLLIN, 0};
  const auto rounded_up =
      std::chrono::ceil<Duration>(std::max(patience, TimePoint::duration::zero()));
  try {
    zmq::poll(&item, 1, rounded_up);
    return true;
  } catch (const zmq::error_t& error) {
    if (error.num() != EINTR) throw;
    return false;
  }
}

// The next whole message, or nothing. Of one with too many frames the last are left out.
std::optional<Frames> next_message(zmq::socket_t& socket) {
  Frames frames;
  bool more = true;
  while (more) {
    zmq::message_t frame;
    if (!uninterrupted([&] { return socket.recv(frame, zmq::recv_flags::dontwait); })) {
      return std::nullopt;
    }
    more = frame.more();
    if (frames.size() <= kServerFrames) frames.push_back(std::move(frame));
  }
  return frames;
}

// Without a copy: ZeroMQ lets go of the bytes.
zmq::message_t message_of(Body body) {
  auto owned = std::make_unique<Body>(std::move(body));
  const ByteView bytes = *owned;
  zmq::message_t message(
      const_cast<std::byte*>(bytes.data()), bytes.size(),
      [](void*, void* hint) { delete static_cast<Body*>(hint); }, owned.get());
  static_cast<void>(owned.release());
  return message;
}

ByteView view(const zmq::message_t& message) {
  return {static_cast<const std::byte*>(message.data()), message.size()};
}

Body body_of(zmq::message_t message) {
  const auto owner = std::make_shared<const zmq::message_t>(std::move(message));
  return {owner, view(*owner)};
}

// Sends what can be sent at once. What does not go out (a full queue, a lost connection) is sent
// again by the protocol. The body's memory is shared, not copied.
void send_message(zmq::socket_t& socket, std::optional<std::string_view> route,
                  const Header& header, zmq::message_t& body) {
  const auto put = [&](zmq::message_t message, zmq::send_flags more) {
    const auto flags = more | zmq::send_flags::dontwait;
    return uninterrupted([&] { return socket.send(message, flags); }).has_value();
  };
  if (route && !put(zmq::message_t(*route), zmq::send_flags::sndmore)) return;
  if (!put(message_of(encode(header)), zmq::send_flags::sndmore)) return;
  zmq::message_t copy;
  copy.copy(body);
  put(std::move(copy), zmq::send_flags::none);
}

void set_common_options(zmq::socket_t& socket, std::size_t window, std::int64_t message_bytes) {
  // Each of a window's requests, its repetition, and room for `pending`s.
  const int messages = static_cast<int>(4 * window + 16);
  socket.set(zmq::sockopt::linger, 0);
  socket.set(zmq::sockopt::sndhwm, messages);
  socket.set(zmq::sockopt::rcvhwm, messages);
  socket.set(zmq::sockopt::maxmsgsize, message_bytes);
  socket.set(zmq::sockopt::heartbeat_ivl, kHeartbeatEvery_ms);
  socket.set(zmq::sockopt::heartbeat_timeout, kHeartbeatTimeout_ms);
}

}  // namespace

// ---- Client

struct Client::Impl {
  struct Request {
    std::uint64_t sequence = 0;
    zmq::message_t body;
    TimePoint sent_at;
    std::optional<Body> answer;
  };

  Impl(Address server, std::string peer, ClientIdentity identity, ClientLimits bounds, Clock time)
      : address(std::move(server)),
        peer_name(std::move(peer)),
        limits(bounds),
        clock(std::move(time)),
        header{.run_id = std::move(identity.run_id),
               .client = {identity.role, identity.index},
               .incarnation = identity.incarnation,
               .refusal = {}} {
    CORRIDOR_CHECK(limits.window >= 1 && limits.resend_after > Duration::zero());
    set_common_options(socket, limits.window, kReplyBytesMax);
    socket.set(zmq::sockopt::connect_timeout, kConnectTimeout_ms);
    socket.set(zmq::sockopt::reconnect_ivl, kReconnectFirst_ms);
    socket.set(zmq::sockopt::reconnect_ivl_max, kReconnectLast_ms);
    try {
      socket.connect(address);
    } catch (const zmq::error_t& error) {
      throw Failure("cannot connect to the {}: {} is no address ({})", peer_name, address,
                    error.what());
    }
  }

  void send_request(Request& request) {
    header.sequence = request.sequence;
    request.sent_at = clock();
    send_message(socket, std::nullopt, header, request.body);
  }

  void resend_overdue() {
    for (Request& request : requests) {
      const bool overdue = clock() - request.sent_at >= limits.resend_after;
      if (!request.answer && overdue) send_request(request);
    }
  }

  // Time that nobody spent in `receive` counts for one resend_after at most: a request may be
  // parked without a word, and only its repetitions must be answered at once.
  void count_silence() {
    const TimePoint now = clock();
    silence += std::min<TimePoint::duration>(now - looked_at, limits.resend_after);
    looked_at = now;
    if (requests.empty()) silence = TimePoint::duration::zero();
    if (silence < limits.peer_timeout) return;
    throw Failure("{} at {} has been silent for {} s: it has ended or cannot be reached", peer_name,
                  address, in_seconds(limits.peer_timeout));
  }

  void handle(Frames frames) {
    Header reply;
    try {
      if (frames.size() != kClientFrames) throw Malformed(fmt::format("{} frames", frames.size()));
      reply = decode_header(view(frames[0]));
    } catch (const Malformed& error) {
      throw Failure("{} at {} answers nonsense: {}", peer_name, address, error.what());
    }
    if (reply.kind == MessageKind::kRefused) {
      throw Failure("{} at {} refused: {}", peer_name, address, reply.refusal);
    }
    // All but what differs between one client's messages.
    Header expected = header;
    expected.sequence = reply.sequence;
    expected.kind = reply.kind;
    if (reply != expected || reply.kind == MessageKind::kRequest) {
      throw Failure("{} at {} answers nonsense: a message that is not for this client", peer_name,
                    address);
    }
    silence = TimePoint::duration::zero();
    if (reply.kind != MessageKind::kReply || requests.empty()) return;
    const std::uint64_t place = reply.sequence - requests.front().sequence;  // wraps for old ones
    if (place < requests.size() && !requests[place].answer) {
      requests[place].answer = body_of(std::move(frames[1]));
    }
  }

  std::optional<Body> take_answer() {
    if (requests.empty() || !requests.front().answer) return std::nullopt;
    std::optional<Body> answer = std::move(requests.front().answer);
    requests.pop_front();
    return answer;
  }

  // When to look again although nothing came.
  TimePoint wake_at(TimePoint deadline) const {
    if (!requests.empty()) deadline = std::min(deadline, looked_at + limits.peer_timeout - silence);
    for (const Request& request : requests) {
      if (!request.answer) deadline = std::min(deadline, request.sent_at + limits.resend_after);
    }
    return deadline;
  }

  Address address;
  std::string peer_name;
  ClientLimits limits;
  Clock clock;
  Header header;
  zmq::context_t context{1};
  zmq::socket_t socket{context, zmq::socket_type::dealer};
  std::uint64_t last_sequence = 0;
  std::deque<Request> requests;    // unanswered, or waiting for the answer to an older one
  TimePoint::duration silence{0};  // of the peer, so far
  TimePoint looked_at;
};

Client::Client(Address server, std::string peer, ClientIdentity identity, ClientLimits limits,
               Clock clock)
    : impl_(std::make_unique<Impl>(std::move(server), std::move(peer), std::move(identity), limits,
                                   std::move(clock))) {}
Client::~Client() = default;

std::uint64_t Client::send(Body body) {
  Impl& impl = *impl_;
  CORRIDOR_CHECK(impl.requests.size() < impl.limits.window, "window {}", impl.limits.window);
  if (impl.requests.empty()) impl.looked_at = impl.clock();
  impl.requests.push_back({++impl.last_sequence, message_of(std::move(body)), {}, {}});
  impl.send_request(impl.requests.back());
  return impl.last_sequence;
}

std::optional<Body> Client::receive(Duration patience) {
  Impl& impl = *impl_;
  const TimePoint deadline = impl.clock() + patience;
  while (true) {
    for (int i = 0; i < kHandledAtOnce; ++i) {
      std::optional<Frames> frames = next_message(impl.socket);
      if (!frames) break;
      impl.handle(*std::move(frames));
    }
    if (std::optional<Body> answer = impl.take_answer()) return answer;
    impl.count_silence();
    impl.resend_overdue();
    const TimePoint now = impl.clock();
    if (now >= deadline || !wait_for_message(impl.socket, impl.wake_at(deadline) - now)) {
      return std::nullopt;
    }
  }
}

std::size_t Client::unanswered() const { return impl_->requests.size(); }

// ---- Server

namespace {

struct Answer {
  MessageKind kind = MessageKind::kPending;  // none yet
  std::string refusal;
  zmq::message_t body;
};

// One client, as far as the server remembers it.
struct Peer {
  std::uint64_t incarnation = 0;
  std::string route;           // ZeroMQ's name of the connection that it last spoke by
  std::uint64_t last = 0;      // sequence number handed out
  std::deque<Answer> answers;  // to the last requests up to `last`

  // To the request of this number; nothing when it is remembered no more.
  Answer* answer_to(std::uint64_t sequence) {
    const std::uint64_t age = last - sequence;
    return age < answers.size() ? &answers[answers.size() - 1 - age] : nullptr;
  }
};

// ZeroMQ binds to numbers and interfaces only; people write names.
Address bindable(const Address& address) {
  constexpr std::string_view kTcp = "tcp://";
  const std::size_t colon = address.rfind(':');
  if (!address.starts_with(kTcp) || colon < kTcp.size()) return address;
  const std::string host = address.substr(kTcp.size(), colon - kTcp.size());
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (getaddrinfo(host.c_str(), nullptr, &hints, &found) != 0) return address;
  char number[NI_MAXHOST] = "";
  const int error = getnameinfo(found->ai_addr, found->ai_addrlen, number, sizeof number, nullptr,
                                0, NI_NUMERICHOST);
  freeaddrinfo(found);
  return error == 0 ? std::string(kTcp) + number + address.substr(colon) : address;
}

const char* advice(int error) {
  switch (error) {
    case EADDRINUSE:
      return "another process listens there: end it, or choose other ports (run.replay_port, "
             "run.learner_port)";
    case EADDRNOTAVAIL:
    case ENODEV:
      return "this machine has no such interface: correct run.host";
    case EACCES:
      return "not permitted: choose ports from 1024 on in [run]";
    default:
      return "correct [run]";
  }
}

}  // namespace

struct Server::Impl {
  Impl(const Address& address, std::string run, ServerLimits bounds)
      : run_id(std::move(run)), limits(bounds) {
    CORRIDOR_CHECK(limits.window >= 1);
    set_common_options(socket, limits.window, static_cast<std::int64_t>(limits.message_bytes));
    try {
      socket.bind(bindable(address));
    } catch (const zmq::error_t& error) {
      throw Failure("cannot listen at {}: {}; {}", address, error.what(), advice(error.num()));
    }
  }

  // What is new of a message; the rest is dealt with here.
  std::optional<IncomingRequest> handle(Frames frames) {
    const std::optional<Header> header = decode_request(frames);
    if (!header) {
      ++dropped;
      return std::nullopt;
    }
    const std::string route = frames[0].to_string();
    Peer* const peer = admit(*header, route);
    if (!peer) return std::nullopt;
    peer->route = route;
    if (header->sequence > peer->last + 1) return std::nullopt;  // its predecessor comes again
    if (header->sequence <= peer->last) {
      if (Answer* const answer = peer->answer_to(header->sequence)) {
        send_answer(*header, *peer, *answer);
      } else {
        ++dropped;
      }
      return std::nullopt;
    }
    if (peer->answers.size() == limits.window) {
      if (peer->answers.front().kind == MessageKind::kPending) {
        refuse_stranger(*header, route,
                        fmt::format("more than {} unanswered requests", limits.window));
        return std::nullopt;
      }
      peer->answers.pop_front();
    }
    peer->answers.emplace_back();
    peer->last = header->sequence;
    return IncomingRequest{*header, body_of(std::move(frames[2]))};
  }

  std::optional<Header> decode_request(const Frames& frames) const {
    if (frames.size() != kServerFrames) return std::nullopt;
    try {
      Header header = decode_header(view(frames[1]));
      const bool is_request = header.kind == MessageKind::kRequest && header.sequence > 0;
      return is_request ? std::optional(std::move(header)) : std::nullopt;
    } catch (const Malformed&) {
      return std::nullopt;
    }
  }

  // The client that speaks, or nothing when it was refused.
  Peer* admit(const Header& header, const std::string& route) {
    const auto refuse = [&](const std::string& text) {
      refuse_stranger(header, route, text);
      return nullptr;
    };
    if (header.protocol != kProtocolVersion) {
      return refuse(fmt::format("it speaks protocol {}, you {}: use one version of corridor",
                                kProtocolVersion, header.protocol));
    }
    if (header.run_id != run_id) return refuse("it serves another run");
    const auto known = peers.find(header.client);
    if (known != peers.end() && header.incarnation == known->second.incarnation) {
      return &known->second;
    }
    if (known != peers.end() && header.incarnation < known->second.incarnation) {
      return refuse("a newer process has taken your place");
    }
    if (header.sequence != 1) return refuse("it has restarted and does not know you: restart too");
    if (known == peers.end() && peers.size() >= limits.clients) {
      return refuse(fmt::format("it has {} clients already", limits.clients));
    }
    Peer& peer = peers[header.client];
    peer = Peer{.incarnation = header.incarnation, .route = route, .last = 0, .answers = {}};
    return &peer;
  }

  void send_answer(Header header, const Peer& peer, Answer& answer) {
    header.kind = answer.kind;
    header.refusal = answer.refusal;
    send_message(socket, peer.route, header, answer.body);
  }

  void refuse_stranger(Header header, const std::string& route, const std::string& text) {
    ++dropped;
    header.protocol = kProtocolVersion;
    header.kind = MessageKind::kRefused;
    header.refusal = text;
    send_message(socket, route, header, nothing);
  }

  void answer(const IncomingRequest& request, Answer answer) {
    const auto found = peers.find(request.client);
    if (found == peers.end() || found->second.incarnation != request.incarnation) return;
    Peer& peer = found->second;
    Answer* const slot = peer.answer_to(request.sequence);
    CORRIDOR_CHECK(slot, "request {} of {}", request.sequence, peer.last);
    CORRIDOR_CHECK(slot->kind == MessageKind::kPending, "request {} answered twice",
                   request.sequence);
    *slot = std::move(answer);
    send_answer(request, peer, *slot);
  }

  std::string run_id;
  ServerLimits limits;
  zmq::context_t context{1};
  zmq::socket_t socket{context, zmq::socket_type::router};
  std::map<ClientId, Peer> peers;
  std::uint64_t dropped = 0;
  zmq::message_t nothing;  // the body of a message that has none
};

Server::Server(const Address& address, std::string run_id, ServerLimits limits)
    : impl_(std::make_unique<Impl>(address, std::move(run_id), limits)) {}
Server::~Server() = default;

std::optional<IncomingRequest> Server::receive(Duration patience) {
  const TimePoint deadline = steady_now() + patience;
  while (true) {
    for (int i = 0; i < kHandledAtOnce; ++i) {
      std::optional<Frames> frames = next_message(impl_->socket);
      if (!frames) break;
      if (auto request = impl_->handle(*std::move(frames))) return request;
    }
    const TimePoint now = steady_now();
    if (now >= deadline || !wait_for_message(impl_->socket, deadline - now)) return std::nullopt;
  }
}

void Server::reply(const IncomingRequest& to, Body body) {
  impl_->answer(to, {MessageKind::kReply, "", message_of(std::move(body))});
}

void Server::refuse(const IncomingRequest& request, const std::string& text) {
  impl_->answer(request, {MessageKind::kRefused, text.substr(0, kRefusalBytesMax), {}});
}

std::uint64_t Server::dropped() const { return impl_->dropped; }

void Server::reject_malformed(const IncomingRequest& request, const std::string& reason) {
  ++impl_->dropped;
  refuse(request, "malformed request: " + reason);
}

}  // namespace corridor
