// Draws slots in proportion to their values: a complete binary tree whose inner nodes hold the sums
// of their children.
//
// Numeric contract: float64 throughout. A sum is always recomputed from its two children, never
// incremented: the tree is a pure function of its leaves, so no history of updates can make it
// drift, and one rebuilt from the same leaves has the same bits. A slot of value 0 is never drawn.
// Cost: memory of 2 doubles a slot (capacity rounded up to a power of two); `set` and `sample` take
// O(log capacity) for each slot; adjacent slots share their way up. One thread.
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
  // finite and >= 0, their sum finite (CHECK).
  void set(std::span<const std::uint64_t> slots, std::span<const double> values);

  // slots[i] becomes the one in whose share of the line the point units[i] * total() lies, all
  // shares laid end to end in the order of the slots. Units are in [0, 1]; 1, which rounding can
  // yield, counts as just below. total() > 0 (CHECK).
  void sample(std::span<const double> units, std::span<std::uint64_t> slots) const;

  double value(std::uint64_t slot) const { return nodes_[leaves_ + slot]; }
  double total() const { return nodes_[1]; }

 private:
  std::size_t capacity_;
  std::size_t leaves_;         // capacity rounded up to a power of two
  std::vector<double> nodes_;  // [1] the root; children of i: 2i, 2i + 1; slots from [leaves_]
  std::vector<std::size_t> climbing_;  // scratch of `set`: the nodes changed in one level
};

}  // namespace corridor::replay
