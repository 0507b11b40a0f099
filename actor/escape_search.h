// SPDX-License-Identifier: Apache-2.0
// Is there a sequence of actions that does not end in a collision? Pure: what an action leads to is
// the caller's to find out.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "proto/run/hindsight_record.h"

namespace corridor::actor {

// What came of driving on with some first actions, and from there always with the first choice.
struct Attempt {
  // One list a step after the first actions, the most promising first.
  std::vector<std::vector<std::uint8_t>> choices;
  bool collided = false;  // in the last of those steps
  bool operator==(const Attempt&) const = default;
};

struct EscapeSearch {
  Verdict verdict = Verdict::kUndecided;
  std::int64_t attempts = 0;
  std::vector<std::uint8_t> escape;  // the actions that avoid it; empty unless kAvoidable
};

// Depth first over the choices, of which every attempt reports those that it came to; what begins
// with a sequence that has collided is not tried. Undecided after `attempts_max` attempts, and when
// `attempt` returns nothing.
EscapeSearch search_escape(
    std::int64_t attempts_max,
    const std::function<std::optional<Attempt>(std::span<const std::uint8_t> first_actions)>&
        attempt);

}  // namespace corridor::actor
