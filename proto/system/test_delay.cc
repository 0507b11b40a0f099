#include "proto/system/test_delay.h"

#include <charconv>
#include <chrono>
#include <cstdlib>
#include <string_view>
#include <thread>

#include "proto/base/failure.h"
#include "proto/base/random.h"
#include "proto/system/identity.h"

namespace corridor {

TestDelay test_delay() {
  const char* const text = std::getenv(kTestDelayVariable);
  if (text == nullptr) return [] {};
  const std::string_view number = text;
  const char* const end = number.data() + number.size();
  double most_ms = 0.0;
  const auto [rest, error] = std::from_chars(number.data(), end, most_ms);
  if (error != std::errc() || rest != end || !(most_ms >= 0.0 && most_ms <= 10'000.0)) {
    throw Failure("{}={}: from 0 to 10000 milliseconds, please", kTestDelayVariable, text);
  }
  return [most_ms, seed = random_64_bits(), calls = std::uint64_t{0}]() mutable {
    const double share = random_unit(seed, Purpose::kWireDelay, {calls++});
    std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(share * most_ms));
  };
}

}  // namespace corridor
