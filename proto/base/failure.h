// SPDX-License-Identifier: Apache-2.0
// How things go wrong: `Failure` for what a user or the world did, CORRIDOR_CHECK for bugs.
#pragma once

#include <stdexcept>
#include <string>

#include "proto/base/format.h"

namespace corridor {

// A bad configuration, a lost peer, a corrupt file. Its text is one line that says what, where and
// what to do. Thrown anywhere, caught once, in run_program (proto/system/program.h).
class Failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;

  template <typename... Args>
  explicit Failure(fmt::format_string<Args...> format, Args&&... args) requires(sizeof...(Args) > 0)
      : std::runtime_error(fmt::format(format, std::forward<Args>(args)...)) {}
};

// Prints the text and aborts: the program has a bug and must not go on with wrong values.
[[noreturn]] void check_failed(const char* condition, const char* file, int line,
                               const std::string& values);

}  // namespace corridor

// An always-on assertion for what only a bug can break. The further arguments are a format string
// and the values to print.
#define CORRIDOR_CHECK(condition, ...)                                                         \
  do {                                                                                         \
    if (!(condition)) [[unlikely]]                                                             \
      ::corridor::check_failed(#condition, __FILE__, __LINE__, ::fmt::format("" __VA_ARGS__)); \
  } while (false)
