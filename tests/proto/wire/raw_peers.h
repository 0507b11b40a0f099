// SPDX-License-Identifier: Apache-2.0
// Peers of Client and Server that do what theirs never would: a client and a server that send what
// a test says, and a link between them that loses and repeats messages.
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>
#include <zmq.hpp>

#include "proto/base/random.h"
#include "proto/wire/codec.h"
#include "proto/wire/endpoint.h"

namespace corridor::testing_support {

inline const std::string kRun(32, 'a');
inline constexpr Duration kSoon{10'000};  // for what must come: reached only by a failing test

inline Bytes bytes_of(const std::string& text) {
  const auto* data = reinterpret_cast<const std::byte*>(text.data());
  return {data, data + text.size()};
}
inline std::string text_of(ByteView bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// One message of these frames: Bytes, or messages as they came.
template <typename Frame>
void send_all(zmq::socket_t& socket, const std::vector<Frame>& frames) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    socket.send(zmq::buffer(frames[i].data(), frames[i].size()),
                i + 1 < frames.size() ? zmq::send_flags::sndmore : zmq::send_flags::none);
  }
}

// A client without manners: sends what the test says.
class RawClient {
 public:
  explicit RawClient(const Address& address) {
    socket_.set(zmq::sockopt::linger, 0);
    socket_.set(zmq::sockopt::rcvtimeo, static_cast<int>(kSoon.count()));
    socket_.connect(address);
  }
  void send_frames(const std::vector<Bytes>& frames) { send_all(socket_, frames); }
  void request(std::uint64_t sequence, const std::string& body, std::uint64_t incarnation = 1) {
    send_frames({encode(header(sequence, incarnation)), bytes_of(body)});
  }
  static Header header(std::uint64_t sequence, std::uint64_t incarnation = 1) {
    Header result;
    result.run_id = kRun;
    result.incarnation = incarnation;
    result.sequence = sequence;
    return result;
  }
  std::pair<Header, std::string> receive() {
    zmq::message_t head, body;
    if (!socket_.recv(head) || !socket_.recv(body)) throw std::runtime_error("no answer");
    return {decode_header({static_cast<const std::byte*>(head.data()), head.size()}),
            body.to_string()};
  }

 private:
  zmq::context_t context_;
  zmq::socket_t socket_{context_, zmq::socket_type::dealer};
};

// A server without manners: sends to its only client what the test says.
class RawServer {
 public:
  explicit RawServer(const Address& address) {
    socket_.set(zmq::sockopt::linger, 0);
    socket_.set(zmq::sockopt::rcvtimeo, static_cast<int>(kSoon.count()));
    socket_.bind(address);
  }
  // The next request's.
  Header receive() {
    zmq::message_t head, body;
    if (!socket_.recv(route_) || !socket_.recv(head) || !socket_.recv(body)) {
      throw std::runtime_error("no request");
    }
    return decode_header({static_cast<const std::byte*>(head.data()), head.size()});
  }
  void send_frames(const std::vector<Bytes>& frames) {
    socket_.send(zmq::buffer(route_.data(), route_.size()), zmq::send_flags::sndmore);
    send_all(socket_, frames);
  }

 private:
  zmq::context_t context_;
  zmq::socket_t socket_{context_, zmq::socket_type::router};
  zmq::message_t route_;
};

// A link between a client and a server that loses and repeats messages, by chance.
class FlakyLink {
 public:
  FlakyLink(const Address& front, const Address& back) {
    front_.set(zmq::sockopt::linger, 0);
    back_.set(zmq::sockopt::linger, 0);
    front_.bind(front);
    back_.connect(back);
  }
  // Passes on what is there.
  void pump() {
    while (auto frames = take(front_)) {
      route_ = frames->at(0).to_string();
      frames->erase(frames->begin());
      for (int i = copies(); i > 0; --i) send_all(back_, *frames);
    }
    while (auto frames = take(back_)) {
      frames->insert(frames->begin(), zmq::message_t(route_));
      for (int i = copies(); i > 0; --i) send_all(front_, *frames);
    }
  }

 private:
  using Frames = std::vector<zmq::message_t>;
  int copies() {
    const double draw = random_unit(5, Purpose::kWireDelay, {draws_++});
    return draw < 0.3 ? 0 : draw < 0.5 ? 2 : 1;
  }
  static std::optional<Frames> take(zmq::socket_t& socket) {
    Frames frames;
    do {
      frames.emplace_back();
      if (!socket.recv(frames.back(), zmq::recv_flags::dontwait)) return std::nullopt;
    } while (frames.back().more());
    return frames;
  }

  zmq::context_t context_;
  zmq::socket_t front_{context_, zmq::socket_type::router};
  zmq::socket_t back_{context_, zmq::socket_type::dealer};
  std::string route_;
  std::uint64_t draws_ = 0;
};

}  // namespace corridor::testing_support
