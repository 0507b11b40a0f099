// SPDX-License-Identifier: Apache-2.0
// One 64-bit hash (XXH3) for everything that is compared or checked: files, trajectories, runs.
#pragma once

#include <xxhash.h>

#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "proto/base/format.h"

namespace corridor {

class Hash {
 public:
  Hash() : state_(XXH3_createState()) { XXH3_64bits_reset(state_.get()); }

  void add(const void* data, std::size_t size) { XXH3_64bits_update(state_.get(), data, size); }
  void add(std::string_view text) {
    add_value(static_cast<std::uint64_t>(text.size()));
    add(text.data(), text.size());
  }
  // The bytes of a number, as this machine lays them out. Doubles hash by bits: -0.0 is not 0.0.
  template <typename T>
  requires std::is_arithmetic_v<T>
  void add_value(T value) { add(&value, sizeof value); }
  template <typename T>
  requires std::is_arithmetic_v<T>
  void add_values(std::span<const T> values) {
    add_value(static_cast<std::uint64_t>(values.size()));
    add(values.data(), values.size_bytes());
  }

  std::uint64_t value() const { return XXH3_64bits_digest(state_.get()); }
  std::string hex() const { return fmt::format("{:016x}", value()); }

 private:
  struct Free {
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
  };
  std::unique_ptr<XXH3_state_t, Free> state_;
};

// Of bytes, in hex.
inline std::string hash_of(std::string_view content) {
  Hash hash;
  hash.add(content.data(), content.size());
  return hash.hex();
}

}  // namespace corridor
