// How much a message may hold (proto/wire/wire.capnp): a sender keeps to it, a receiver refuses
// what is larger, and a configuration whose messages would be larger is refused before.
#pragma once

#include <cstddef>
#include <cstdint>

namespace corridor {

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
