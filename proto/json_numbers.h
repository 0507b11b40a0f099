// Whole numbers out of JSON that anybody may have written. nlohmann's get<int>() casts whatever
// number it finds, which is undefined for 1e87.
#pragma once

#include <concepts>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "proto/failure.h"

namespace corridor {

// Throws Failure when the value is no whole number, or one that T does not hold.
template <std::integral T>
T whole_number(const nlohmann::json& value) {
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

// Of a list. Throws Failure likewise, or when the value is none.
template <std::integral T>
std::vector<T> whole_numbers(const nlohmann::json& list) {
  if (!list.is_array()) throw Failure("{} where a list belongs", list.type_name());
  std::vector<T> numbers;
  for (const nlohmann::json& value : list) numbers.push_back(whole_number<T>(value));
  return numbers;
}

}  // namespace corridor
