// SPDX-License-Identifier: Apache-2.0
#include "proto/base/failure.h"

#include <cstdio>
#include <cstdlib>

namespace corridor {

void check_failed(const char* condition, const char* file, int line, const std::string& values) {
  // Not the logger: it may be what is broken.
  std::fprintf(stderr, "%s:%d: check failed: %s%s%s\n", file, line, condition,
               values.empty() ? "" : ": ", values.c_str());
  std::fflush(stderr);
  std::abort();
}

}  // namespace corridor
