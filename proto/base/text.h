// SPDX-License-Identifier: Apache-2.0
// Numbers as people read them, and read from text.
#pragma once

#include <charconv>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "proto/base/format.h"

namespace corridor {

// What speeds are shown in.
inline constexpr double kKphPerMps = 3.6;

// 1400000 -> "1,400,000".
std::string grouped(std::int64_t number);

// 67 -> "1 min 07 s"; 4000 -> "1 h 06 min". Rounded to whole seconds.
std::string duration_text(double seconds);

// "a, b, c". `shown`: what of each, as of std::ranges' projections.
template <typename List, typename Shown = std::identity>
std::string listed(const List& values, std::string_view separator = ", ", Shown shown = {}) {
  std::string list;
  std::string_view before;
  for (const auto& value : values) {
    list += fmt::format("{}{}", before, std::invoke(shown, value));
    before = separator;
  }
  return list;
}

// With `to` in place of each `from`.
std::string replaced(const std::string& text, char from, std::string_view to);

// As a shell takes it for one word: in single quotes where it needs them.
std::string shell_quoted(const std::string& word);

// The number that the whole text is; nothing when it is none, or one that T does not hold.
template <typename T>
std::optional<T> parse_number(std::string_view text) {
  T number{};
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || rest != end) return std::nullopt;
  return number;
}

}  // namespace corridor
