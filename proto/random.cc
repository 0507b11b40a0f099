#include "proto/random.h"

namespace corridor {
namespace {

// SplitMix64's finaliser (Steele, Lea, Flood 2014): a bijection that passes BigCrush on counters.
constexpr std::uint64_t mix(std::uint64_t value) {
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9ULL;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebULL;
  return value ^ (value >> 31);
}

constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15ULL;

}  // namespace

std::uint64_t random_bits(std::uint64_t seed, Purpose purpose,
                          std::initializer_list<std::uint64_t> indices) {
  std::uint64_t state = mix(seed + kGolden);
  state = mix((state ^ static_cast<std::uint64_t>(purpose)) + kGolden);
  // Absorbing one index at a time keeps (1, 2) and (2, 1), and (1) and (1, 0), apart.
  for (const std::uint64_t index : indices) state = mix((state ^ mix(index + kGolden)) + kGolden);
  return mix(state + kGolden * (indices.size() + 1));
}

double random_unit(std::uint64_t seed, Purpose purpose,
                   std::initializer_list<std::uint64_t> indices) {
  return static_cast<double>(random_bits(seed, purpose, indices) >> 11) * 0x1.0p-53;
}

std::uint64_t random_below(std::uint64_t bound, std::uint64_t seed, Purpose purpose,
                           std::initializer_list<std::uint64_t> indices) {
  const auto product = static_cast<unsigned __int128>(random_bits(seed, purpose, indices)) * bound;
  return static_cast<std::uint64_t>(product >> 64);
}

}  // namespace corridor
