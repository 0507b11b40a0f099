// SPDX-License-Identifier: Apache-2.0
#include "proto/wire/connect.h"

#include "proto/base/hash.h"

namespace corridor {
namespace {

ClientLimits limits_of(const RunSettings& settings) {
  return {.peer_timeout =
              std::chrono::round<Duration>(std::chrono::duration<double>(settings.peer_timeout_s))};
}

}  // namespace

Addresses addresses(const RunSettings& settings, const std::string& run_id) {
  if (settings.transport == Transport::kTcp) {
    return {fmt::format("tcp://{}:{}", settings.host, settings.replay_port),
            fmt::format("tcp://{}:{}", settings.host, settings.learner_port)};
  }
  const std::string name = hash_of(run_id);
  return {fmt::format("ipc://@corridor-{}-replay", name),
          fmt::format("ipc://@corridor-{}-learner", name)};
}

Client connect_to_replay(const RunSettings& settings, const ClientIdentity& identity) {
  return Client(addresses(settings, identity.run_id).replay, "replay server", identity,
                limits_of(settings));
}

Client connect_to_learner(const RunSettings& settings, const ClientIdentity& identity) {
  return Client(addresses(settings, identity.run_id).learner, "learner", identity,
                limits_of(settings));
}

}  // namespace corridor
