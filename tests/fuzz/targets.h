// SPDX-License-Identifier: Apache-2.0
// What reads bytes that anybody may have written: for a fuzzer, and for the test that feeds them
// what fuzzers found.
#pragma once

#include <span>
#include <string_view>

namespace corridor::fuzz {

struct Target {
  const char* name;  // of its corpus too: corpus/<name>
  // Reads the bytes as what they claim to be. They may be refused (Malformed, Failure); whatever
  // else happens is a finding: another exception, a CHECK, a report of a sanitizer.
  void (*read)(std::string_view bytes);
};

std::span<const Target> targets();

}  // namespace corridor::fuzz
