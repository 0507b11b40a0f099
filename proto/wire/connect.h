// SPDX-License-Identifier: Apache-2.0
// Where a run's servers listen, and what every conversation with them does alike.
#pragma once

#include <string>
#include <variant>

#include "proto/base/failure.h"
#include "proto/settings/settings.h"
#include "proto/wire/endpoint.h"

namespace corridor {

struct Addresses {
  std::string replay;
  std::string learner;
};
// From [run] and the run id (of which ipc names show a hash only: the id is what lets one in).
Addresses addresses(const RunSettings& settings, const std::string& run_id);

// In the background, as Client says; with the limits of [run].
Client connect_to_replay(const RunSettings& settings, const ClientIdentity& identity);
Client connect_to_learner(const RunSettings& settings, const ClientIdentity& identity);

// The reply that was asked for: `decode` gives a variant of all. Throws Failure when it is another
// one, or malformed.
template <typename Reply, typename Decode>
Reply expect(const Body& body, const Decode& decode, const char* peer) {
  try {
    auto reply = decode(body);
    if (auto* value = std::get_if<Reply>(&reply)) return std::move(*value);
  } catch (const Malformed& malformed) {
    throw Failure("the {}'s answer is malformed: {}", peer, malformed.what());
  }
  throw Failure("the {} answered another question: do all processes run the same build?", peer);
}

}  // namespace corridor
