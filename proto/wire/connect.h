// Where a run's servers listen, and what both ends of a conversation do alike.
#pragma once

#include <string>
#include <variant>

#include "proto/base/failure.h"
#include "proto/settings/settings.h"

namespace corridor {

struct Addresses {
  std::string replay;
  std::string learner;
};
// From [run] and the run id (of which ipc names show a hash only: the id is what lets one in).
Addresses addresses(const RunSettings& settings, const std::string& run_id);

// The reply that was asked for. Throws Failure when it is another one.
template <typename Reply, typename Variant>
Reply expect(Variant reply, const std::string& peer) {
  if (auto* value = std::get_if<Reply>(&reply)) return std::move(*value);
  throw Failure("the {} answered with a message that was not asked for", peer);
}

}  // namespace corridor
