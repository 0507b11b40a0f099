// SPDX-License-Identifier: Apache-2.0
// JSON values, and numbers out of those that anybody may have written: get<int>() casts whatever
// number it finds, which is undefined for 1e87. Pure.
#pragma once

#include <concepts>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "proto/base/failure.h"
#include "proto/base/json_fwd.h"

namespace corridor {

// Throws Failure naming `name` (the file) when the text is no JSON.
inline Json parse_json(std::string_view text, const std::string& name) {
  try {
    return Json::parse(text);
  } catch (const Json::exception& error) {
    throw Failure("{} is not JSON: {}", name, error.what());
  }
}

// Throws Failure when the value is no whole number, or one that T does not hold.
template <std::integral T>
T whole_number(const Json& value) {
  if (value.is_number_unsigned()) {
    const auto number = value.get<std::uint64_t>();
    if (std::in_range<T>(number)) return static_cast<T>(number);
  } else if (value.is_number_integer()) {
    const auto number = value.get<std::int64_t>();
    if (std::in_range<T>(number)) return static_cast<T>(number);
  }
  throw Failure("{} is no whole number from {} to {}",
                value.is_number() ? value.dump() : value.type_name(), std::numeric_limits<T>::min(),
                std::numeric_limits<T>::max());
}

}  // namespace corridor
