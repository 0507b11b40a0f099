// SPDX-License-Identifier: Apache-2.0
#include "replay/store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "proto/base/failure.h"
#include "proto/base/random.h"
#include "proto/run/checkpoints.h"
#include "proto/wire/messages.h"
#include "tests/replay/chi_square.h"

namespace corridor::replay {
namespace {

using testing::Each;
using testing::IsEmpty;

constexpr RowLayout kLayout{1};
constexpr std::uint64_t kSeed = 11;

DqnSettings settings(std::int64_t capacity, double alpha = 1.0, double offset = 1e-9) {
  DqnSettings result;
  result.capacity = capacity;
  result.priority_exponent = alpha;
  result.priority_offset = offset;
  return result;
}

Store make_store(const DqnSettings& chosen, std::uint64_t first_key = 0) {
  return {chosen, kLayout, kSeed, Phase::kMop, first_key};
}

// Rows that say which they are: all floats of row i are first + i.
void insert(Store& store, const std::vector<float>& priorities, float first = 0.0F) {
  std::vector<float> rows;
  for (std::size_t i = 0; i < priorities.size(); ++i) {
    rows.insert(rows.end(), kLayout.stride(), first + static_cast<float>(i));
  }
  store.insert(rows, priorities);
}

Batch sample(Store& store, std::size_t count, double importance_exponent) {
  Batch batch;
  batch.observations = static_cast<std::uint32_t>(kLayout.observations);
  batch.rows.resize(count * kLayout.stride());
  batch.keys.resize(count);
  batch.weights.resize(count);
  store.sample(importance_exponent, {batch.rows, batch.keys, batch.weights});
  return batch;
}

// |TD errors| from 1e-6 to 1e3, log-uniform.
std::vector<float> skewed_priorities(std::size_t count) {
  std::vector<float> result;
  for (std::size_t i = 0; i < count; ++i) {
    const double unit = random_unit(kSeed, Purpose::kBootstrap, {i});
    result.push_back(static_cast<float>(std::pow(10.0, -6.0 + 9.0 * unit)));
  }
  return result;
}

// Each stratum of a batch is an experiment of its own: its draws are independent and fall on the
// leaves that overlap it, in proportion to the overlap.
TEST(StoreTest, StratifiedDrawsFollowSkewedPriorities) {
  constexpr std::size_t kRows = 600;
  constexpr std::uint32_t kStrata = 16;
  constexpr int kBatches = 20'000;
  for (const double alpha : {1.0, 0.6}) {
    Store store = make_store(settings(kRows, alpha));
    const std::vector<float> priorities = skewed_priorities(kRows);
    insert(store, priorities);

    std::vector<std::vector<std::size_t>> counts(kStrata, std::vector<std::size_t>(kRows));
    for (int batch = 0; batch < kBatches; ++batch) {
      const std::vector<std::uint64_t> keys = sample(store, kStrata, 0.4).keys;
      for (std::uint32_t stratum = 0; stratum < kStrata; ++stratum)
        ++counts[stratum][keys[stratum]];
    }

    std::vector<long double> ends{0.0L};  // of the leaves' shares
    for (const float priority : priorities) {
      ends.push_back(ends.back() + std::pow(priority + 1e-9L, static_cast<long double>(alpha)));
    }
    ChiSquare test;
    for (std::uint32_t stratum = 0; stratum < kStrata; ++stratum) {
      const long double begin = ends.back() * stratum / kStrata;
      const long double end = ends.back() * (stratum + 1) / kStrata;
      std::vector<double> probabilities;
      for (std::size_t row = 0; row < kRows; ++row) {
        const long double overlap = std::min(end, ends[row + 1]) - std::max(begin, ends[row]);
        probabilities.push_back(static_cast<double>(std::max(overlap, 0.0L) / (end - begin)));
      }
      test.add(probabilities, counts[stratum]);
    }
    EXPECT_GT(test.degrees(), 100.0) << "alpha " << alpha;
    EXPECT_GT(test.p_value(), 1e-3) << "alpha " << alpha;
    EXPECT_LT(test.p_value(), 1.0 - 1e-3) << "alpha " << alpha;
  }
}

TEST(StoreTest, WeightsFollowTheFormula) {
  constexpr std::size_t kRows = 300;
  constexpr double kAlpha = 0.6;
  constexpr double kOffset = 1e-3;
  Store store = make_store(settings(512, kAlpha, kOffset));
  const std::vector<float> priorities = skewed_priorities(kRows);
  insert(store, priorities);
  std::vector<double> leaves;
  for (const float priority : priorities) leaves.push_back(std::pow(priority + kOffset, kAlpha));
  const double total = std::accumulate(leaves.begin(), leaves.end(), 0.0);

  for (const double beta : {0.0, 0.4, 1.0}) {
    const Batch batch = sample(store, 64, beta);
    std::vector<double> weights;
    for (const std::uint64_t key : batch.keys) {
      weights.push_back(std::pow(kRows * leaves[key] / total, -beta));
    }
    const double largest = *std::max_element(weights.begin(), weights.end());
    for (std::size_t i = 0; i < weights.size(); ++i) {
      EXPECT_NEAR(batch.weights[i], weights[i] / largest, 1e-5 * weights[i] / largest);
    }
    EXPECT_EQ(*std::max_element(batch.weights.begin(), batch.weights.end()), 1.0F);
  }
}

TEST(StoreTest, ABatchCarriesTheRowsOfItsKeysOverManyWraps) {
  Store store = make_store(settings(100), 37);
  std::uint64_t inserted = 0;
  for (std::uint64_t round = 0; round < 200; ++round) {
    const std::uint64_t count = random_below(250, kSeed, Purpose::kBootstrap, {round});
    insert(store, std::vector<float>(count, 1.0F), static_cast<float>(37 + inserted));
    inserted += count;
    ASSERT_EQ(store.inserted(), inserted);
    ASSERT_EQ(store.size(), std::min<std::uint64_t>(inserted, 100));
    if (store.size() == 0) continue;
    const Batch batch = sample(store, 50, 0.4);
    for (std::size_t i = 0; i < 50; ++i) {
      ASSERT_GE(batch.keys[i] + 100, store.next_key());
      ASSERT_LT(batch.keys[i], store.next_key());
      const auto row = batch.rows.begin() + static_cast<std::ptrdiff_t>(i * kLayout.stride());
      ASSERT_THAT(std::vector<float>(row, row + static_cast<std::ptrdiff_t>(kLayout.stride())),
                  Each(static_cast<float>(batch.keys[i])));
    }
  }
}

TEST(StoreTest, ALatePriorityNeverReachesTheSlotsNextTenant) {
  Store store = make_store(settings(4));
  insert(store, {1, 1, 1, 1});
  // Keys 0 and 1 give way to 4 and 5, in slots 0 and 1.
  insert(store, {1, 1}, 4.0F);
  store.update(std::vector<std::uint64_t>{0, 1, 2}, std::vector<float>{1e30F, 1e30F, 3.0F});
  EXPECT_EQ(store.stale_priorities(), 2U);
  // Shares in the order of the slots: keys 4, 5, 2 (thrice), 3.
  EXPECT_THAT(sample(store, 6, 0.4).keys, testing::ElementsAre(4, 5, 2, 2, 2, 3));
  insert(store, {1}, 6.0F);
  store.update(std::vector<std::uint64_t>{3, 2}, std::vector<float>{1.0F, 1.0F});
  EXPECT_EQ(store.stale_priorities(), 3U);
}

TEST(StoreTest, KeysOfAnEarlierPhaseAreStale) {
  Store store = make_store(settings(100), 1000);
  insert(store, {1, 1});
  store.update(std::vector<std::uint64_t>{999, 5}, std::vector<float>{9.0F, 9.0F});
  EXPECT_EQ(store.stale_priorities(), 2U);
  EXPECT_THAT(sample(store, 2, 0.4).keys, testing::UnorderedElementsAre(1000, 1001));
}

TEST(StoreTest, ADrawOfNothingIsEmptyAndCostsNoNumbers) {
  Store store = make_store(settings(8));
  EXPECT_THAT(sample(store, 0, 0.4).rows, IsEmpty());
  insert(store, {1});
  sample(store, 0, 0.4);
  EXPECT_EQ(store.sampled(), 0U);
}

TEST(StoreTest, ARestoredStoreDrawsTheSameBits) {
  Store store = make_store(settings(64, 0.6, 1e-3), 500);
  for (int chunk = 0; chunk < 5; ++chunk) insert(store, skewed_priorities(30), 30.0F * chunk);
  const Batch batch = sample(store, 16, 0.5);
  store.update(batch.keys, skewed_priorities(16));
  TensorFile file, rows;
  store.save(file);
  rows.put(kRowsTensor, store.rows_from(store.oldest_key()));

  Store restored = make_store(settings(64, 0.6, 1e-3));
  restored.load(file, "x");
  restored.load_rows(store.oldest_key(), rows, "x");
  TensorFile again;
  restored.save(again);
  EXPECT_EQ(again, file);
  for (int step = 0; step < 50; ++step) {
    const Batch expected = sample(store, 16, 0.5);
    ASSERT_EQ(sample(restored, 16, 0.5), expected);
    store.update(expected.keys, skewed_priorities(16));
    restored.update(expected.keys, skewed_priorities(16));
    insert(store, skewed_priorities(7));
    insert(restored, skewed_priorities(7));
  }
}

TEST(StoreTest, ADamagedCheckpointIsAFailure) {
  Store store = make_store(settings(8));
  insert(store, {1, 2, 3});
  TensorFile good;
  store.save(good);
  const auto load = [&](const TensorFile& file) { make_store(settings(8)).load(file, "x"); };
  EXPECT_NO_THROW(load(good));
  for (const char* name : {kLeavesTensor, kNextKeyTensor, "first_key", "sampled"}) {
    TensorFile damaged = good;
    damaged.tensors.erase(name);
    EXPECT_THROW(load(damaged), Failure) << name;
  }
  TensorFile keys = good;
  keys.put("first_key", std::vector<std::uint64_t>{4});
  EXPECT_THROW(load(keys), Failure);
  TensorFile leaves = good;
  leaves.put(kLeavesTensor, std::vector<float>{1.0F, std::nanf(""), 1.0F});
  EXPECT_THROW(load(leaves), Failure);
  Store restored = make_store(settings(8));
  restored.load(good, "x");
  const std::vector<float> whole = store.rows_from(0);
  const auto load_rows = [&](std::uint64_t first_key, const std::vector<float>& values) {
    TensorFile rows;
    rows.put(kRowsTensor, values);
    restored.load_rows(first_key, rows, "x");
  };
  EXPECT_NO_THROW(load_rows(0, whole));
  EXPECT_THROW(load_rows(1, whole), Failure);
  EXPECT_THROW(load_rows(4, {}), Failure);
  EXPECT_THROW(load_rows(0, std::vector<float>(whole.size() - 1)), Failure);
  EXPECT_THROW(load_rows(0, std::vector<float>(whole.size(), std::nanf(""))), Failure);
  // Of a larger capacity.
  EXPECT_THROW(make_store(settings(2)).load(good, "x"), Failure);
}

TEST(StoreTest, OnlyFiniteNumbersFromZeroOnArePriorities) {
  EXPECT_TRUE(are_priorities(std::vector<float>{0.0F, 1e-30F, std::numeric_limits<float>::max()}));
  EXPECT_FALSE(are_priorities(std::vector<float>{1.0F, std::nanf("")}));
  EXPECT_FALSE(are_priorities(std::vector<float>{std::numeric_limits<float>::infinity()}));
  EXPECT_FALSE(are_priorities(std::vector<float>{-1e-30F}));
}

}  // namespace
}  // namespace corridor::replay
