// SPDX-License-Identifier: Apache-2.0
// What would happen if: a function called in a copy of this process, so that whatever it does to
// the world, a simulator in this process included, has not happened afterwards.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <vector>

namespace corridor::actor {

using Bytes = std::vector<std::uint8_t>;

// Returns what `function` returns; the copy, and all that it did to memory, is gone then. Costs a
// fork(), of a process with SUMO 2 to 4 ms. Only for processes of one thread: the copy has no
// other. The copy does not outlive this process. Throws Failure when `function` throws (with its
// text), when the copy dies, and when it has not returned within `patience`.
Bytes what_if(const std::function<Bytes()>& function, std::chrono::milliseconds patience);

}  // namespace corridor::actor
