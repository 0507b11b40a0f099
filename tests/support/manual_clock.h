// SPDX-License-Identifier: Apache-2.0
// Time that passes when a test says so.
#pragma once

#include <atomic>

#include "proto/system/clock.h"

namespace corridor::testing_support {

// Any thread may move it and look at it. Outlives what has its clock.
class ManualClock {
 public:
  Clock clock() const {
    return [this] { return now(); };
  }
  TimePoint now() const { return TimePoint(TimePoint::duration(ticks_.load())); }
  void advance(TimePoint::duration by) { ticks_ += by.count(); }

 private:
  std::atomic<TimePoint::rep> ticks_ = 0;
};

}  // namespace corridor::testing_support
