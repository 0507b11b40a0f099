#include "replay/sum_tree.h"

#include <bit>
#include <cmath>

#include "proto/failure.h"

namespace corridor::replay {

SumTree::SumTree(std::size_t capacity)
    : capacity_(capacity), leaves_(std::bit_ceil(capacity)), nodes_(2 * leaves_, 0.0) {
  CORRIDOR_CHECK(capacity >= 1, "capacity {}", capacity);
}

void SumTree::set(std::span<const std::uint64_t> slots, std::span<const double> values) {
  CORRIDOR_CHECK(slots.size() == values.size(), "{} slots, {} values", slots.size(), values.size());
  climbing_.clear();
  for (std::size_t i = 0; i < slots.size(); ++i) {
    CORRIDOR_CHECK(slots[i] < capacity_, "slot {} of {}", slots[i], capacity_);
    CORRIDOR_CHECK(std::isfinite(values[i]) && values[i] >= 0.0, "value {}", values[i]);
    nodes_[leaves_ + slots[i]] = values[i];
    climbing_.push_back(leaves_ + slots[i]);
  }
  // Level by level, so that both children are final before their sum is taken.
  for (std::size_t width = leaves_; width > 1; width /= 2) {
    std::size_t parents = 0;
    for (const std::size_t node : climbing_) {
      const std::size_t parent = node / 2;
      if (parents > 0 && climbing_[parents - 1] == parent) continue;
      nodes_[parent] = nodes_[2 * parent] + nodes_[2 * parent + 1];
      climbing_[parents++] = parent;
    }
    climbing_.resize(parents);
  }
  CORRIDOR_CHECK(std::isfinite(total()), "the values' sum overflows");
}

void SumTree::sample(std::span<const double> units, std::span<std::uint64_t> slots) const {
  CORRIDOR_CHECK(units.size() == slots.size(), "{} units, {} slots", units.size(), slots.size());
  CORRIDOR_CHECK(total() > 0.0, "nothing to draw from");
  for (std::size_t i = 0; i < units.size(); ++i) {
    CORRIDOR_CHECK(units[i] >= 0.0 && units[i] <= 1.0, "unit {}", units[i]);
    double point = units[i] * total();
    std::size_t node = 1;
    while (node < leaves_) {
      const double left = nodes_[2 * node];
      const double right = nodes_[2 * node + 1];
      // Rounding may leave the point at or beyond the end of the node's share. Never entering an
      // empty right half keeps every node on the way positive, down to the slot.
      if (point < left || right == 0.0) {
        node = 2 * node;
      } else {
        point -= left;
        node = 2 * node + 1;
      }
    }
    slots[i] = node - leaves_;
  }
}

}  // namespace corridor::replay
