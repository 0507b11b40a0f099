// SPDX-License-Identifier: Apache-2.0
// The messages of proto/wire/wire.capnp as plain values; meaning, order and limits are documented
// there.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "proto/settings/named_networks.h"

namespace corridor {

// Raised with every change of proto/wire/wire.capnp or of a meaning in it.
inline constexpr std::uint32_t kProtocolVersion = 6;

enum class Role : std::uint16_t { kActor, kLearner };
enum class MessageKind : std::uint16_t { kRequest, kReply, kPending, kRefused };

// A client as its server sees it. Ordered, so that it can be a map's key.
struct ClientId {
  Role role = Role::kActor;
  std::uint32_t index = 0;
  auto operator<=>(const ClientId&) const = default;
};

struct Header {
  std::uint32_t protocol = kProtocolVersion;
  std::string run_id;
  ClientId client;
  std::uint64_t incarnation = 0;
  std::uint64_t sequence = 0;
  MessageKind kind = MessageKind::kRequest;
  std::string refusal;
  bool operator==(const Header&) const = default;
};

struct OpenEpisode {
  std::uint64_t episode = 0;
  std::vector<std::uint8_t> actions;
  bool operator==(const OpenEpisode&) const = default;
};

// To the replay server.
struct Join {
  bool operator==(const Join&) const = default;
};
struct Insert {
  std::uint64_t round = 0;
  std::uint32_t observations = 0;
  std::vector<float> rows;
  std::vector<float> priorities;
  OpenEpisode open;
  bool operator==(const Insert&) const = default;
};
struct OpenBlock {
  std::uint64_t round = 0;
  bool operator==(const OpenBlock&) const = default;
};
struct Step {
  std::vector<std::uint64_t> keys;
  std::vector<float> priorities;
  std::uint32_t count = 0;
  double importance_exponent = 0.0;
  bool operator==(const Step&) const = default;
};
struct Save {
  std::string directory;
  std::string previous;
  bool operator==(const Save&) const = default;
};
using ReplayRequest = std::variant<Join, Insert, OpenBlock, Step, Save>;

// From the replay server.
struct Joined {
  std::uint64_t next_round = 0;
  OpenEpisode open;
  bool operator==(const Joined&) const = default;
};
struct Inserted {
  bool operator==(const Inserted&) const = default;
};
struct Opened {
  std::uint32_t batches = 0;
  bool operator==(const Opened&) const = default;
};
// Not among ReplayReply: it is written and read in place (proto/wire/codec.h).
struct Batch {
  std::uint32_t observations = 0;
  std::vector<float> rows;
  std::vector<std::uint64_t> keys;
  std::vector<float> weights;
  bool operator==(const Batch&) const = default;
};
struct Saved {
  bool complete = false;
  bool operator==(const Saved&) const = default;
};
using ReplayReply = std::variant<Joined, Inserted, Opened, Saved>;

// To the learner.
struct WeightsWanted {
  std::uint64_t version = 0;
  bool operator==(const WeightsWanted&) const = default;
};
struct SelectionOutcome {
  std::uint64_t round = 0;
  std::uint32_t episodes = 0;
  std::uint64_t steps = 0;
  double reward = 0.0;
  std::uint64_t collisions = 0;
  bool operator==(const SelectionOutcome&) const = default;
};
using LearnerRequest = std::variant<WeightsWanted, SelectionOutcome>;

// From the learner.
struct Weights {
  std::uint64_t version = 0;
  Networks networks;
  bool operator==(const Weights&) const = default;
};
struct Noted {
  bool operator==(const Noted&) const = default;
};
using LearnerReply = std::variant<Weights, Noted>;

}  // namespace corridor
