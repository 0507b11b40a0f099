// SPDX-License-Identifier: Apache-2.0
// Records <-> JSON objects. A record names each of its members once, for both directions:
//
//   template <typename Self, typename Field>
//   static void fields(Self& self, Field field) {
//     field("steps", self.steps);
//   }
//   void check() const;  // if there is one: throws Failure for what no such record can hold
//
// Members are numbers, texts, enums with names (proto/settings/choices.h), records, lists of these,
// and optional ones: null where there is none, or, with `field("at", self.at, kLeftOut)`, not there
// at all. Pure.
#pragma once

#include <concepts>
#include <exception>
#include <string>
#include <type_traits>

#include "proto/base/json.h"
#include "proto/settings/choices.h"

namespace corridor {

struct LeftOut {};
inline constexpr LeftOut kLeftOut;

template <typename T>
concept JsonRecord = requires(T& record) {
  T::fields(record, [](const char*, auto&, auto...) {});
};
template <typename T>
concept JsonOptional = requires(T& value) {
  value.emplace();
  value.has_value();
};
template <typename T>
concept JsonList = requires(T& value) {
  { value.emplace_back() } -> std::same_as<typename T::value_type&>;  // not so of bits
};

// J: Json, or OrderedJson for the members' own order.
template <typename J = Json, typename T>
J json_of(const T& value) {
  if constexpr (JsonRecord<const T>) {
    J object = J::object();
    T::fields(value, [&](const char* name, const auto& member, auto... left_out) {
      if constexpr (sizeof...(left_out) > 0) {
        if (!member) return;
      }
      object[name] = json_of<J>(member);
    });
    return object;
  } else if constexpr (JsonOptional<T>) {
    return value ? json_of<J>(*value) : J(nullptr);
  } else if constexpr (JsonList<T>) {
    J list = J::array();
    for (const auto& member : value) list.push_back(json_of<J>(member));
    return list;
  } else if constexpr (std::is_enum_v<T>) {
    return name_of(value);
  } else {
    return value;
  }
}

// Throws an exception that says which member is missing or wrong.
template <typename J, typename T>
void read_value(const J& json, T& into) {
  if constexpr (JsonRecord<T>) {
    T::fields(into, [&](const char* name, auto& member, auto... left_out) {
      if (sizeof...(left_out) > 0 && !json.contains(name)) return;
      const auto& value = json.at(name);
      try {
        read_value(value, member);
      } catch (const std::exception& error) {
        throw Failure("{}: {}", name, error.what());
      }
    });
    if constexpr (requires { into.check(); }) into.check();
  } else if constexpr (JsonOptional<T>) {
    into.reset();
    if (!json.is_null()) read_value(json, into.emplace());
  } else if constexpr (JsonList<T>) {
    if (!json.is_array()) throw Failure("{} where a list belongs", json.type_name());
    into.clear();
    for (const J& value : json) read_value(value, into.emplace_back());
  } else if constexpr (std::is_enum_v<T>) {
    into = parse_choice<T>(json.template get<std::string>());
  } else if constexpr (std::integral<T> && !std::same_as<T, bool>) {
    into = whole_number<T>(json);
  } else {
    json.get_to(into);
  }
}

// Throws Failure "<name> is no <what>: ..." when a member is missing or wrong.
template <typename T, typename J>
T parse_record(const J& json, const std::string& name, const char* what) {
  T record;
  try {
    read_value(json, record);
  } catch (const std::exception& error) {
    throw Failure("{} is no {}: {}", name, what, error.what());
  }
  return record;
}

}  // namespace corridor
