// SPDX-License-Identifier: Apache-2.0
#include "replay/sum_tree.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "proto/base/failure.h"

namespace corridor::replay {
namespace {

constexpr std::size_t kGroup = 4;  // children are added, and looked through, four by four

template <typename T>
double sum_of_group(const T* child) {
  return (static_cast<double>(child[0]) + child[1]) + (static_cast<double>(child[2]) + child[3]);
}

// Two numbers side by side, added by one instruction on every processor of 64 bits.
using Pair = double __attribute__((vector_size(2 * sizeof(double))));

Pair pair_at(const double* from) {
  Pair pair;
  std::memcpy(&pair, from, sizeof pair);
  return pair;
}
Pair pair_at(const float* from) {
  float __attribute__((vector_size(2 * sizeof(float)))) pair;
  std::memcpy(&pair, from, sizeof pair);
  return __builtin_convertvector(pair, Pair);
}

template <typename T>
double sum_of(const T* child) {
  const Pair first_half =
      (pair_at(child) + pair_at(child + 2)) + (pair_at(child + 4) + pair_at(child + 6));
  const Pair second_half =
      (pair_at(child + 8) + pair_at(child + 10)) + (pair_at(child + 12) + pair_at(child + 14));
  const Pair sum = first_half + second_half;
  return sum[0] + sum[1];
}

// Which of four the point lies in, laid end to end; the point then counts from that one's begin.
// Without a branch: which one it is, is random.
std::size_t pick(double first, double second, double third, double& point) {
  const double end_of_second = first + second;
  const double end_of_third = end_of_second + third;
  const std::size_t index = static_cast<std::size_t>(point >= first) +
                            static_cast<std::size_t>(point >= end_of_second) +
                            static_cast<std::size_t>(point >= end_of_third);
  const double begins[4] = {0.0, first, end_of_second, end_of_third};
  point -= begins[index];
  return index;
}

template <typename T>
std::size_t child_at(const T* child, double& point) {
  const std::size_t group = pick(sum_of_group(child), sum_of_group(child + kGroup),
                                 sum_of_group(child + 2 * kGroup), point);
  const T* of_group = child + kGroup * group;
  const std::size_t index = kGroup * group + pick(of_group[0], of_group[1], of_group[2], point);
  if (child[index] > T{0}) [[likely]]
    return index;
  // Rounding has left the point at or beyond the end of the node's share: it belongs to the last
  // child that has one, and stays at the end of that.
  std::size_t last = index;
  while (last > 0 && !(child[last] > T{0})) --last;
  point = static_cast<double>(child[last]);
  return last;
}

}  // namespace

SumTree::SumTree(std::size_t capacity)
    : capacity_(capacity), values_((capacity + kFanOut - 1) / kFanOut) {
  CORRIDOR_CHECK(capacity >= 1, "capacity {}", capacity);
  for (std::size_t nodes = values_.size(); nodes > 1;) {
    nodes = (nodes + kFanOut - 1) / kFanOut;
    sums_.emplace_back(nodes);
  }
}

void SumTree::set(std::span<const std::uint64_t> slots, std::span<const float> values) {
  CORRIDOR_CHECK(slots.size() == values.size(), "{} slots, {} values", slots.size(), values.size());
  climbing_.clear();
  for (std::size_t i = 0; i < slots.size(); ++i) {
    CORRIDOR_CHECK(slots[i] < capacity_, "slot {} of {}", slots[i], capacity_);
    CORRIDOR_CHECK(std::isfinite(values[i]) && values[i] >= 0.0F, "value {}", values[i]);
    const std::size_t node = slots[i] / kFanOut;
    values_[node].children[slots[i] % kFanOut] = values[i];
    if (climbing_.empty() || climbing_.back() != node) climbing_.push_back(node);
  }
  climb();
}

// Level by level, so that all children are final before their sum is taken.
void SumTree::climb() {
  for (std::size_t level = 0; level < sums_.size(); ++level) {
    std::size_t parents = 0;
    for (const std::size_t node : climbing_) {
      const double sum =
          level == 0 ? sum_of(values_[node].children) : sum_of(sums_[level - 1][node].children);
      const std::size_t parent = node / kFanOut;
      sums_[level][parent].children[node % kFanOut] = sum;
      if (parents == 0 || climbing_[parents - 1] != parent) climbing_[parents++] = parent;
    }
    climbing_.resize(parents);
  }
  total_ = sums_.empty() ? sum_of(values_[0].children) : sum_of(sums_.back()[0].children);
}

void SumTree::sample(std::span<const double> units, std::span<std::uint64_t> slots) const {
  CORRIDOR_CHECK(units.size() == slots.size(), "{} units, {} slots", units.size(), slots.size());
  CORRIDOR_CHECK(total_ > 0.0, "nothing to draw from");
  points_.resize(units.size());
  for (std::size_t i = 0; i < units.size(); ++i) {
    CORRIDOR_CHECK(units[i] >= 0.0 && units[i] <= 1.0, "unit {}", units[i]);
    points_[i] = units[i] * total_;
    slots[i] = 0;  // the node, until the last level makes it the slot
  }
  for (std::size_t level = sums_.size(); level-- > 0;) {
    const Node<double>* nodes = sums_[level].data();
    for (std::size_t i = 0; i < slots.size(); ++i) {
      slots[i] = kFanOut * slots[i] + child_at(nodes[slots[i]].children, points_[i]);
      if (level > 0) {
        __builtin_prefetch(&sums_[level - 1][slots[i]].children[0]);
        __builtin_prefetch(&sums_[level - 1][slots[i]].children[kFanOut / 2]);
      } else {
        __builtin_prefetch(&values_[slots[i]]);
      }
    }
  }
  for (std::size_t i = 0; i < slots.size(); ++i) {
    slots[i] = kFanOut * slots[i] + child_at(values_[slots[i]].children, points_[i]);
  }
}

}  // namespace corridor::replay
