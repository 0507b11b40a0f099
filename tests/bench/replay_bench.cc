// SPDX-License-Identifier: Apache-2.0
// The replay server's store, in process: a million rows, batches of 512.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <vector>

#include "proto/base/random.h"
#include "proto/settings/transition.h"
#include "replay/power.h"
#include "replay/store.h"
#include "replay/sum_tree.h"

namespace corridor::replay {
namespace {

constexpr std::int64_t kRows = 1 << 20;
constexpr std::uint32_t kBatch = 512;
constexpr std::size_t kChunk = 256;

double unit(std::uint64_t index) { return random_unit(1, Purpose::kBootstrap, {index}); }

// Log-uniform over four magnitudes, as TD errors are.
std::vector<float> priorities(std::size_t count, std::uint64_t first = 0) {
  std::vector<float> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = static_cast<float>(std::pow(10.0, -4.0 + 4.0 * unit(first + i)));
  }
  return values;
}

// Full, of rows with so many observations.
Store full_store(int observations, std::int64_t capacity = kRows) {
  DqnSettings settings;
  settings.capacity = capacity;
  Store store(settings, {observations}, 1, Phase::kMop, 0);
  const std::vector<float> rows(kChunk * RowLayout{observations}.stride(), 0.5F);
  for (std::int64_t i = 0; i < capacity; i += static_cast<std::int64_t>(kChunk)) {
    store.insert(rows, priorities(kChunk, static_cast<std::uint64_t>(i)));
  }
  return store;
}

// Room for a batch.
struct Room {
  explicit Room(int observations)
      : rows(kBatch * RowLayout{observations}.stride()), keys(kBatch), weights(kBatch) {}
  void draw(Store& store) { store.sample(0.4, {rows, keys, weights}); }
  std::vector<float> rows;
  std::vector<std::uint64_t> keys;
  std::vector<float> weights;
};

void count_rows(benchmark::State& state, std::size_t rows_each) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(rows_each));
}

// Observations for rows of 344 bytes with their key, as other servers are measured with, and of the
// paper's MoP.
constexpr int kObservations344 = 40;
constexpr int kObservationsMop = kMopScalars + kMopPerCorridor * 5;
// The second capacity is no power of two.
void rings(benchmark::internal::Benchmark* benchmark) {
  benchmark->Args({kObservations344, kRows})
      ->Args({kObservationsMop, kRows})
      ->Args({kObservationsMop, 200'000})
      ->Unit(benchmark::kMicrosecond);
}

void StoreSample(benchmark::State& state) {
  Store store = full_store(static_cast<int>(state.range(0)), state.range(1));
  Room room(static_cast<int>(state.range(0)));
  for (auto _ : state) room.draw(store);
  count_rows(state, kBatch);
}
BENCHMARK(StoreSample)->Apply(rings);

// What memory alone takes for a batch's rows, wherever they are.
void Gather(benchmark::State& state) {
  const std::size_t stride = RowLayout{static_cast<int>(state.range(0))}.stride();
  const auto count = static_cast<std::uint64_t>(state.range(1));
  std::vector<float> ring(count * stride, 0.5F), batch(kBatch * stride);
  std::vector<std::uint64_t> slots(kBatch);
  std::uint64_t draw = 0;
  for (auto _ : state) {
    state.PauseTiming();
    for (auto& slot : slots) slot = random_below(count, 1, Purpose::kBootstrap, {draw++});
    std::sort(slots.begin(), slots.end());
    state.ResumeTiming();
    for (std::size_t i = 0; i < kBatch; ++i) {
      if (i + 8 < kBatch) {
        const float* row = ring.data() + slots[i + 8] * stride;
        for (std::size_t j = 0; j < stride; j += 16) __builtin_prefetch(row + j);
      }
      std::memcpy(batch.data() + i * stride, ring.data() + slots[i] * stride,
                  stride * sizeof(float));
    }
    benchmark::DoNotOptimize(batch.data());
  }
  count_rows(state, kBatch);
}
BENCHMARK(Gather)->Apply(rings);

// What the server stops for when a checkpoint is taken: the rows since the one before, and all
// priorities.
void StoreSnapshot(benchmark::State& state) {
  constexpr std::uint64_t kNewRows = 50'000;
  const Store store = full_store(static_cast<int>(state.range(0)), state.range(1));
  for (auto _ : state) {
    TensorFile head;
    store.save(head);
    benchmark::DoNotOptimize(store.rows_from(store.next_key() - kNewRows));
  }
}
BENCHMARK(StoreSnapshot)->Apply(rings);

// Of the rows that were drawn just before, as a learner returns them.
void StoreUpdate(benchmark::State& state) {
  Store store = full_store(static_cast<int>(state.range(0)), state.range(1));
  Room room(static_cast<int>(state.range(0)));
  room.draw(store);
  const std::vector<float> fresh = priorities(kBatch, 7);
  for (auto _ : state) store.update(room.keys, fresh);
  count_rows(state, kBatch);
}
BENCHMARK(StoreUpdate)->Apply(rings);

void StoreInsert(benchmark::State& state) {
  const int observations = static_cast<int>(state.range(0));
  Store store = full_store(observations, state.range(1));
  const std::vector<float> rows(kChunk * RowLayout{observations}.stride(), 0.25F);
  const std::vector<float> fresh = priorities(kChunk, 7);
  for (auto _ : state) store.insert(rows, fresh);
  count_rows(state, kChunk);
}
BENCHMARK(StoreInsert)->Apply(rings);

struct Drawn {
  Drawn() : tree(kRows), units(kBatch), slots(kBatch) {
    std::vector<std::uint64_t> all(kRows);
    std::iota(all.begin(), all.end(), 0);
    tree.set(all, priorities(kRows));
  }
  void draw(std::uint64_t number) {
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      units[i] = (i + unit((number << 16) + i)) / kBatch;
    }
    tree.sample(units, slots);
  }
  SumTree tree;
  std::vector<double> units;
  std::vector<std::uint64_t> slots;
};

void TreeSample(benchmark::State& state) {
  Drawn drawn;
  std::vector<std::vector<double>> units;
  for (std::uint64_t i = 0; i < 64; ++i) {
    drawn.draw(i);
    units.push_back(drawn.units);
  }
  std::size_t next = 0;
  for (auto _ : state) {
    drawn.tree.sample(units[next++ % units.size()], drawn.slots);
    benchmark::DoNotOptimize(drawn.slots.data());
  }
  count_rows(state, kBatch);
}
BENCHMARK(TreeSample)->Unit(benchmark::kMicrosecond);

void TreeSet(benchmark::State& state) {
  Drawn drawn;
  drawn.draw(1);
  const std::vector<float> fresh = priorities(kBatch, 7);
  for (auto _ : state) drawn.tree.set(drawn.slots, fresh);
  count_rows(state, kBatch);
}
BENCHMARK(TreeSet)->Unit(benchmark::kMicrosecond);

void Power(benchmark::State& state) {
  const std::vector<float> bases = priorities(kBatch);
  std::vector<float> powers(kBatch);
  for (auto _ : state) {
    power(bases, 0.6F, powers);
    benchmark::DoNotOptimize(powers.data());
  }
  count_rows(state, kBatch);
}
BENCHMARK(Power)->Unit(benchmark::kMicrosecond);

void Draws(benchmark::State& state) {
  std::uint64_t next = 0;
  for (auto _ : state) {
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      benchmark::DoNotOptimize(random_unit(1, Purpose::kReplaySampling, {0, next++}));
    }
  }
  count_rows(state, kBatch);
}
BENCHMARK(Draws)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace corridor::replay
