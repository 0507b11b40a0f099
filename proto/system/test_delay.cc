// SPDX-License-Identifier: Apache-2.0
#include "proto/system/test_delay.h"

#include <chrono>
#include <cstdlib>
#include <thread>

#include "proto/base/failure.h"
#include "proto/base/random.h"
#include "proto/base/text.h"
#include "proto/system/identity.h"

namespace corridor {

TestDelay test_delay() {
  const char* const text = std::getenv(kTestDelayVariable);
  if (text == nullptr) return [] {};
  const auto most_ms = parse_number<double>(text);
  if (!most_ms || !(*most_ms >= 0.0 && *most_ms <= 10'000.0)) {
    throw Failure("{}={}: from 0 to 10000 milliseconds, please", kTestDelayVariable, text);
  }
  return [most_ms = *most_ms, seed = random_64_bits(), calls = std::uint64_t{0}]() mutable {
    const double share = random_unit(seed, Purpose::kWireDelay, {calls++});
    std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(share * most_ms));
  };
}

}  // namespace corridor
