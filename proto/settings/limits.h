// SPDX-License-Identifier: Apache-2.0
// The most that is taken of what anybody may ask for or send.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

namespace corridor {

// Of an environment, in all.
inline constexpr std::int64_t kStepsMax = 10'000'000'000;
// TOML's largest integer less one: the largest is what the TOML library makes of still larger ones.
inline constexpr std::uint64_t kSeedMax = std::numeric_limits<std::int64_t>::max() - 1;

// How much a message may hold (proto/wire/wire.capnp): a sender keeps to it, a receiver refuses
// what is larger, and a configuration whose messages would be larger is refused before.
inline constexpr std::size_t kMebibyte = 1024 * 1024;

inline constexpr std::size_t kDataBytesMax = 64 * kMebibyte;  // of a Data field
inline constexpr std::size_t kActionsBytesMax = kMebibyte;    // of an open episode's actions
inline constexpr std::size_t kRunIdBytesMax = 64;
inline constexpr std::size_t kRefusalBytesMax = 512;
inline constexpr std::size_t kDirectoryBytesMax = 4096;
inline constexpr std::size_t kNetworkNameBytesMax = 64;
inline constexpr std::size_t kNetworksMax = 8;
inline constexpr std::uint32_t kObservationsMax = 65536;
inline constexpr std::uint32_t kRowsPerStepMax = 65536;

}  // namespace corridor
