// SPDX-License-Identifier: Apache-2.0
// Where a run's servers listen, and what every conversation with them does alike.
#pragma once

#include <filesystem>
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
// From [run], and for ipc from a hash of the run id, which is what lets one in, and of the run's
// directory: a copy of it is another run's.
Addresses addresses(const RunSettings& settings, const std::string& run_id,
                    const std::filesystem::path& directory);

// In the background, as Client says; with the limits of [run]. Processes that talk by ipc have one
// starter, which knows better than they who hangs and who only loads or waits for a processor: they
// wait for ten minutes at least.
Client connect_to_replay(const RunSettings& settings, const ClientIdentity& identity,
                         const std::filesystem::path& directory);
Client connect_to_learner(const RunSettings& settings, const ClientIdentity& identity,
                          const std::filesystem::path& directory);

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
