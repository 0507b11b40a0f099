// SPDX-License-Identifier: Apache-2.0
// Values as TOML writes them, for files and messages. Private to proto/.
#pragma once

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "proto/base/format.h"
#include "proto/settings/choices.h"

namespace corridor {

inline std::string toml_of(bool value) { return value ? "true" : "false"; }
inline std::string toml_of(int value) { return std::to_string(value); }
inline std::string toml_of(std::int64_t value) { return std::to_string(value); }
inline std::string toml_of(std::uint64_t value) { return std::to_string(value); }
// The shortest text that reads as the same number. TOML tells a float by its point or exponent.
inline std::string toml_of(double value) {
  const std::string shortest = fmt::format("{}", value);
  return shortest.find_first_of(".en") == std::string::npos ? shortest + ".0" : shortest;
}
// Of text without quotes, backslashes and control characters.
inline std::string toml_of(const std::string& value) { return '"' + value + '"'; }

template <typename E>
requires std::is_enum_v<E> std::string toml_of(E choice) {
  return toml_of(std::string(name_of(choice)));
}
template <typename T>
std::string toml_of(const std::vector<T>& values) {
  std::string text;
  for (const T& value : values) text += (text.empty() ? "" : ", ") + toml_of(value);
  return '[' + text + ']';
}

}  // namespace corridor
