// SPDX-License-Identifier: Apache-2.0
// A test's hook: slows this process at random, since results must not depend on how fast any is.
#pragma once

#include <functional>

namespace corridor {

// Called once a round or message, where its owner may take its time.
using TestDelay = std::function<void()>;

// Names the environment variable that says up to how many milliseconds, at most 10,000. The
// launcher's processes inherit it.
inline constexpr const char* kTestDelayVariable = "CORRIDOR_TEST_DELAY_MS";

// Sleeps as the variable says, by other amounts in each process; without it, does nothing. Throws
// Failure when it says nonsense.
TestDelay test_delay();

}  // namespace corridor
