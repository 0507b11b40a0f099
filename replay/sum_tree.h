// SPDX-License-Identifier: Apache-2.0
// Draws slots in proportion to their values: a 16-ary tree whose inner nodes hold the sums of their
// children.
//
// Numeric contract: values are float32, sums float64. A sum is always recomputed from its children
// in one order, never incremented: the tree is a pure function of its values, so no history of
// updates can make it drift, and one rebuilt from the same values has the same bits. A slot of
// value 0 is never drawn.
// Cost: memory of 4.6 bytes a slot; `set` and `sample` go down or up level by level for all slots
// together, so that the memory accesses of one level overlap. One thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace corridor::replay {

class SumTree {
 public:
  // All values 0. capacity >= 1.
  explicit SumTree(std::size_t capacity);

  // values[i] becomes the value of slots[i]; a slot named twice keeps the last one. Values are
  // finite and >= 0 (CHECK).
  void set(std::span<const std::uint64_t> slots, std::span<const float> values);

  // slots[i] becomes the one in whose share of the line the point units[i] * total() lies, all
  // shares laid end to end in the order of the slots. Units are in [0, 1]; 1, which rounding can
  // yield, counts as just below. total() > 0 (CHECK).
  void sample(std::span<const double> units, std::span<std::uint64_t> slots) const;

  float value(std::uint64_t slot) const { return values_[slot / kFanOut].children[slot % kFanOut]; }
  double total() const { return total_; }

 private:
  static constexpr std::size_t kFanOut = 16;

  // The children of one node, side by side in memory: a cache line of values, two of sums.
  template <typename T>
  struct alignas(64) Node {
    T children[kFanOut] = {};
  };

  // Recomputes the sums above values_[nodes[i]].
  void climb();

  std::size_t capacity_;
  std::vector<Node<float>> values_;
  // sums_[0][i] holds the sums of values_[16 i] .. values_[16 i + 15], and so on; the last level is
  // one node, whose sum is total_. Empty where values_ is one node.
  std::vector<std::vector<Node<double>>> sums_;
  double total_ = 0.0;

  std::vector<std::size_t> climbing_;   // scratch of `set`: the nodes changed in one level
  mutable std::vector<double> points_;  // scratch of `sample`: where in its node each slot lies
};

}  // namespace corridor::replay
