// SPDX-License-Identifier: Apache-2.0
// libFuzzer's entry; docs/operations.md says how it is run. FUZZ_TARGET chooses the target.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "tests/fuzz/targets.h"

namespace {

const corridor::fuzz::Target& chosen() {
  const char* const wanted = std::getenv("FUZZ_TARGET");
  for (const auto& target : corridor::fuzz::targets()) {
    if (wanted != nullptr && std::string_view(wanted) == target.name) return target;
  }
  std::fprintf(stderr, "FUZZ_TARGET must be one of:");
  for (const auto& target : corridor::fuzz::targets()) std::fprintf(stderr, " %s", target.name);
  std::fprintf(stderr, "\n");
  std::exit(2);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const corridor::fuzz::Target& target = chosen();
  target.read({reinterpret_cast<const char*>(data), size});
  return 0;
}
