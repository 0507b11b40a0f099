// SPDX-License-Identifier: Apache-2.0
#include "proto/system/identity.h"

#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "proto/base/failure.h"
#include "proto/base/text.h"

namespace corridor {
namespace {

constexpr const char* kStarts = "CORRIDOR_STARTS";

}  // namespace

std::uint64_t random_64_bits() {
  std::uint64_t bits = 0;
  if (getrandom(&bits, sizeof bits, 0) == static_cast<ssize_t>(sizeof bits)) return bits;
  throw Failure("the system gives no random numbers: {}", std::strerror(errno));
}

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

std::string folder_identity(const std::filesystem::path& folder) {
  struct stat status {};
  if (stat(folder.c_str(), &status) == 0) return fmt::format("{}:{}", status.st_dev, status.st_ino);
  throw Failure("cannot look at {}: {}", folder.string(), std::strerror(errno));
}

std::uint64_t incarnation_of(std::uint32_t starts, std::uint64_t random) {
  return std::uint64_t{starts} << 32 | random >> 32;
}

std::string start_environment(std::uint32_t starts) {
  return fmt::format("{}={}", kStarts, starts);
}

std::uint64_t draw_incarnation() {
  const char* const text = std::getenv(kStarts);
  const auto starts = text ? parse_number<std::uint32_t>(text) : std::nullopt;
  return incarnation_of(starts.value_or(0), random_64_bits());
}

}  // namespace corridor
