// SPDX-License-Identifier: Apache-2.0
#include "replay/sum_tree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "proto/base/random.h"
#include "tests/replay/chi_square.h"

namespace corridor::replay {
namespace {

constexpr std::uint64_t kDrawSeed = 7;

double unit(std::uint64_t stream, std::uint64_t draw) {
  return random_unit(kDrawSeed, Purpose::kBootstrap, {stream, draw});
}

std::vector<std::uint64_t> slots_below(std::uint64_t count) {
  std::vector<std::uint64_t> slots(count);
  std::iota(slots.begin(), slots.end(), 0);
  return slots;
}

// Log-uniform from 1e-6 to 1e3, in no order, every tenth zero.
std::vector<float> skewed_values(std::size_t count) {
  std::vector<float> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = i % 10 == 9 ? 0.0F : static_cast<float>(std::pow(10.0, -6.0 + 9.0 * unit(0, i)));
  }
  return values;
}

SumTree tree_of(const std::vector<float>& values) {
  SumTree tree(values.size());
  tree.set(slots_below(values.size()), values);
  return tree;
}

std::uint64_t slot_at(const SumTree& tree, double point) {
  std::uint64_t slot = 0;
  tree.sample({&point, 1}, {&slot, 1});
  return slot;
}

TEST(SumTreeTest, EverySlotOwnsItsShareOfTheLineOverNineMagnitudes) {
  // A capacity that is no power of two.
  const std::vector<float> values = skewed_values(3001);
  const SumTree tree = tree_of(values);
  long double before = 0.0L;
  for (std::size_t slot = 0; slot < values.size(); ++slot) {
    if (values[slot] > 0.0) {
      const long double middle = before + 0.5L * values[slot];
      const long double quarter = 0.25L * values[slot];
      EXPECT_EQ(slot_at(tree, static_cast<double>((middle - quarter) / tree.total())), slot);
      EXPECT_EQ(slot_at(tree, static_cast<double>((middle + quarter) / tree.total())), slot);
    }
    before += values[slot];
  }
  EXPECT_NEAR(tree.total(), static_cast<double>(before), 1e-12 * tree.total());
}

TEST(SumTreeTest, DrawsInProportionToSkewedValues) {
  const std::vector<float> values = skewed_values(3000);
  const SumTree tree = tree_of(values);
  std::vector<double> probabilities;
  for (const float value : values) probabilities.push_back(value / tree.total());

  std::vector<double> units(1'000'000);
  for (std::size_t i = 0; i < units.size(); ++i) units[i] = unit(1, i);
  std::vector<std::uint64_t> slots(units.size());
  tree.sample(units, slots);
  std::vector<std::size_t> counts(values.size());
  for (const std::uint64_t slot : slots) ++counts[slot];

  ChiSquare test;
  test.add(probabilities, counts);
  EXPECT_GT(test.degrees(), 500.0);
  EXPECT_GT(test.p_value(), 1e-3);
  EXPECT_LT(test.p_value(), 1.0 - 1e-3);
}

TEST(SumTreeTest, NeverDrawsAZeroEvenAtTheEdgesOfTheLine) {
  // Sums of tenths round, so that the line's end and the last share's end differ.
  for (std::size_t count = 1; count < 70; ++count) {
    std::vector<float> values(count + 2, 0.1F);
    values.front() = 0.0F;
    values.back() = 0.0F;
    const SumTree tree = tree_of(values);
    EXPECT_EQ(slot_at(tree, 0.0), 1U);
    EXPECT_EQ(slot_at(tree, std::nextafter(1.0, 0.0)), count);
    EXPECT_EQ(slot_at(tree, 1.0), count);
  }
  std::vector<float> values(1000, 0.0F);
  values[617] = std::numeric_limits<float>::denorm_min();
  const SumTree tree = tree_of(values);
  for (std::uint64_t i = 0; i < 1000; ++i) EXPECT_EQ(slot_at(tree, unit(2, i)), 617U);
}

TEST(SumTreeTest, AMillionUpdatesLeaveTheBitsOfAFreshTree) {
  constexpr std::size_t kCapacity = 1000;
  SumTree tree(kCapacity);
  std::vector<float> values(kCapacity, 0.0F);
  std::vector<std::uint64_t> slots(50);
  std::vector<float> updates(50);
  for (std::uint64_t batch = 0; batch < 20'000; ++batch) {
    for (std::size_t i = 0; i < slots.size(); ++i) {
      const std::uint64_t draw = batch * slots.size() + i;
      slots[i] = static_cast<std::uint64_t>(unit(3, draw) * kCapacity);
      updates[i] = static_cast<float>(std::pow(10.0, -6.0 + 9.0 * unit(4, draw)));
      values[slots[i]] = updates[i];
    }
    tree.set(slots, updates);
  }
  const SumTree fresh = tree_of(values);
  EXPECT_EQ(tree.total(), fresh.total());
  const long double sum = std::accumulate(values.begin(), values.end(), 0.0L);
  EXPECT_NEAR(tree.total(), static_cast<double>(sum), 1e-13 * tree.total());
  for (std::uint64_t i = 0; i < 10'000; ++i) {
    ASSERT_EQ(slot_at(tree, unit(5, i)), slot_at(fresh, unit(5, i)));
  }
}

TEST(SumTreeTest, ASlotNamedTwiceKeepsTheLastValue) {
  SumTree tree(5);
  tree.set(std::vector<std::uint64_t>{3, 1, 3}, std::vector<float>{8.0F, 2.0F, 4.0F});
  EXPECT_EQ(tree.value(3), 4.0);
  EXPECT_EQ(tree.total(), 6.0);
}

TEST(SumTreeTest, OneSlotIsATree) {
  SumTree tree(1);
  tree.set(std::vector<std::uint64_t>{0}, std::vector<float>{2.5F});
  EXPECT_EQ(tree.total(), 2.5);
  EXPECT_EQ(slot_at(tree, 0.99), 0U);
}

TEST(SumTreeDeathTest, ValuesThatAreNoSharesAreBugs) {
  SumTree tree(4);
  const std::vector<std::uint64_t> slot{2};
  EXPECT_DEATH(tree.set(slot, std::vector{-1.0F}), "value -1");
  EXPECT_DEATH(tree.set(slot, std::vector{std::nanf("")}), "value nan");
  EXPECT_DEATH(tree.set(slot, std::vector{std::numeric_limits<float>::infinity()}), "value inf");
  EXPECT_DEATH(tree.set(std::vector<std::uint64_t>{4}, std::vector{1.0F}), "slot 4 of 4");
  EXPECT_DEATH(slot_at(tree, 0.5), "nothing to draw from");
}

}  // namespace
}  // namespace corridor::replay
