// SPDX-License-Identifier: Apache-2.0
#include "proto/base/random.h"

namespace corridor {
namespace {

// SplitMix64's finaliser (Steele, Lea, Flood 2014): a bijection that passes BigCrush on counters.
constexpr std::uint64_t mix(std::uint64_t value) {
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9ULL;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebULL;
  return value ^ (value >> 31);
}

constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15ULL;

// Absorbing one index at a time keeps (1, 2) and (2, 1), and (1) and (1, 0), apart.
constexpr std::uint64_t absorb(std::uint64_t state, std::uint64_t index) {
  return mix((state ^ mix(index + kGolden)) + kGolden);
}

std::uint64_t begin(std::uint64_t seed, Purpose purpose, Indices indices) {
  std::uint64_t state = mix(seed + kGolden);
  state = mix((state ^ static_cast<std::uint64_t>(purpose)) + kGolden);
  for (const std::uint64_t index : indices) state = absorb(state, index);
  return state;
}

constexpr std::uint64_t finish(std::uint64_t state, std::uint64_t indices) {
  return mix(state + kGolden * (indices + 1));
}

constexpr double unit_of(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1.0p-53; }

}  // namespace

std::uint64_t random_bits(std::uint64_t seed, Purpose purpose, Indices indices) {
  return finish(begin(seed, purpose, indices), indices.size());
}

double random_unit(std::uint64_t seed, Purpose purpose, Indices indices) {
  return unit_of(random_bits(seed, purpose, indices));
}

RandomSequence::RandomSequence(std::uint64_t seed, Purpose purpose, Indices first_indices)
    : state_(begin(seed, purpose, first_indices)), indices_(first_indices.size() + 1) {}

double RandomSequence::unit(std::uint64_t index) const {
  return unit_of(finish(absorb(state_, index), indices_));
}

std::uint64_t random_below(std::uint64_t bound, std::uint64_t seed, Purpose purpose,
                           Indices indices) {
  const auto product = static_cast<unsigned __int128>(random_bits(seed, purpose, indices)) * bound;
  return static_cast<std::uint64_t>(product >> 64);
}

}  // namespace corridor
