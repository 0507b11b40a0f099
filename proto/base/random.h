// SPDX-License-Identifier: Apache-2.0
// Every random number of the system is a pure function of counters: (seed, purpose, indices).
// Nothing holds a generator, so no order of calls, threads or processes can reach a result, and
// any draw can be made again after a crash.
#pragma once

#include <cstdint>
#include <initializer_list>

namespace corridor {

// What a number is drawn for. Two purposes never share a stream. Append only: the values are part
// of every recorded result.
enum class Purpose : std::uint64_t {
  kInitialWeights = 1,    // (phase, parameter)
  kExploration = 2,       // (phase, actor, episode, step)
  kRandomBp = 3,          // (episode seed, draw)
  kReplaySampling = 4,    // (phase, draw)
  kTrainingEpisode = 5,   // (phase, actor, episode): an episode seed
  kSelectionEpisode = 6,  // (phase, episode): an episode seed, of the evaluations during training
  kTestEpisode = 7,       // (episode): an episode seed, from an evaluation seed, never the run's
  kSumo = 8,              // the simulator's own seed, from an episode seed
  kTraffic = 9,           // (episode seed, vehicle or step, draw)
  kBlindDriver = 10,      // (episode seed, step, vehicle)
  kBootstrap = 11,        // (draw): resampling for confidence intervals
  kWireDelay = 12,        // tests that slow processes at random
  kChaos = 13,            // tests that kill processes at random
  kObject = 14,           // (episode seed, object, draw)
  kTrainingTraffic = 15,  // (episode seed, quantity)
  kMeasurement = 16,      // (episode seed, instant, quantity, draw)
};

using Indices = std::initializer_list<std::uint64_t>;

// 64 uniform bits. Cost: a few ns for each index.
std::uint64_t random_bits(std::uint64_t seed, Purpose purpose, Indices indices);

// Uniform in [0, 1), 53 bits.
double random_unit(std::uint64_t seed, Purpose purpose, Indices indices);

// The numbers that differ in their last index only: the first ones are absorbed once.
class RandomSequence {
 public:
  RandomSequence(std::uint64_t seed, Purpose purpose, Indices first_indices);
  // random_unit(seed, purpose, {first_indices ..., index}).
  double unit(std::uint64_t index) const;

 private:
  std::uint64_t state_;
  std::uint64_t indices_;
};

// Uniform in {0 .. bound-1}; bound >= 1. The bias is below bound / 2^64.
std::uint64_t random_below(std::uint64_t bound, std::uint64_t seed, Purpose purpose,
                           Indices indices);

}  // namespace corridor
