// SPDX-License-Identifier: Apache-2.0
// The networks of a run, by name, in the order in which they are trained. A further one needs an id
// and a row here, its shape (RunConfig::shape), and what its phase trains it on (actor/rollout.cc).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace corridor {

// Each network is trained in a phase of its own, so one id names both.
enum class NetworkId : std::uint8_t { kMop = 0, kBp = 1 };
using Phase = NetworkId;

struct NamedNetwork {
  NetworkId id;            // its place in the table
  const char* name;        // of its tensors and of its table in a scenario
  const char* phase_name;  // in metrics, and to people
  const char* meaning;     // of its table, for people
};

inline constexpr std::array kNetworks = {
    NamedNetwork{NetworkId::kMop, "mop", "MoP",
                 "The motion planner's deep Q-network and its training."},
    NamedNetwork{NetworkId::kBp, "bp", "BP",
                 "The behaviour planner's, on the trained motion planner."},
};

inline constexpr const NamedNetwork& named_network(NetworkId id) {
  return kNetworks[static_cast<std::size_t>(id)];
}
inline const char* phase_name(Phase phase) { return named_network(phase).phase_name; }

// A set of parameters: of each network as many as RunConfig::parameters says.
struct Networks {
  std::array<std::vector<float>, kNetworks.size()> by_id;

  std::vector<float>& operator[](NetworkId id) { return by_id[static_cast<std::size_t>(id)]; }
  const std::vector<float>& operator[](NetworkId id) const {
    return by_id[static_cast<std::size_t>(id)];
  }
  bool operator==(const Networks&) const = default;
};

}  // namespace corridor
