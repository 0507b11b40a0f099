// SPDX-License-Identifier: Apache-2.0
#include "proto/wire/connect.h"

#include <algorithm>

#include "proto/base/hash.h"
#include "proto/system/identity.h"

namespace corridor {
namespace {

constexpr double kPatienceOnOneMachine_s = 600.0;

ClientLimits limits_of(const RunSettings& settings) {
  const double timeout_s = settings.transport == Transport::kIpc
                               ? std::max(kPatienceOnOneMachine_s, settings.peer_timeout_s)
                               : settings.peer_timeout_s;
  return {.peer_timeout = std::chrono::round<Duration>(std::chrono::duration<double>(timeout_s))};
}

}  // namespace

Addresses addresses(const RunSettings& settings, const std::string& run_id,
                    const std::filesystem::path& directory) {
  if (settings.transport == Transport::kTcp) {
    return {fmt::format("tcp://{}:{}", settings.host, settings.replay_port),
            fmt::format("tcp://{}:{}", settings.host, settings.learner_port)};
  }
  const std::string name = hash_of(run_id + folder_identity(directory));
  return {fmt::format("ipc://@corridor-{}-replay", name),
          fmt::format("ipc://@corridor-{}-learner", name)};
}

Client connect_to_replay(const RunSettings& settings, const ClientIdentity& identity,
                         const std::filesystem::path& directory) {
  return Client(addresses(settings, identity.run_id, directory).replay, "replay server", identity,
                limits_of(settings));
}

Client connect_to_learner(const RunSettings& settings, const ClientIdentity& identity,
                          const std::filesystem::path& directory) {
  return Client(addresses(settings, identity.run_id, directory).learner, "learner", identity,
                limits_of(settings));
}

}  // namespace corridor
