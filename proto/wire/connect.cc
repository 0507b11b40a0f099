#include "proto/wire/connect.h"

#include "proto/base/hash.h"

namespace corridor {
namespace {

std::string hash_of(std::string_view content) {
  Hash hash;
  hash.add(content.data(), content.size());
  return hash.hex();
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

}  // namespace corridor
