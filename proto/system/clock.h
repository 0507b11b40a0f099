// SPDX-License-Identifier: Apache-2.0
// Time as an argument: what repeats, measures or gives up takes a Clock or the time itself, so that
// a test moves it by hand and waits for none. Where a socket or a process is waited for, the wait
// itself is real.
#pragma once

#include <chrono>
#include <functional>

namespace corridor {

// Of a clock that only goes forward, whatever becomes of the calendar's.
using TimePoint = std::chrono::steady_clock::time_point;

// Says what time it is; asked by one thread.
using Clock = std::function<TimePoint()>;

// The machine's.
inline TimePoint steady_now() { return std::chrono::steady_clock::now(); }

inline double in_seconds(TimePoint::duration passed) {
  return std::chrono::duration<double>(passed).count();
}

// Of the machine's, after some moment in the past.
inline double monotonic_s() { return in_seconds(steady_now().time_since_epoch()); }

}  // namespace corridor
