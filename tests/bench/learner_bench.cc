// SPDX-License-Identifier: Apache-2.0
// A training step of one network against the arithmetic that it cannot do without: the matrix
// products of its passes, and one look at every parameter for Adam.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "learner/td_networks.h"
#include "learner/td_update.h"
#include "proto/base/random.h"
#include "tests/bench/paper.h"
#include "tests/bench/td_floor.h"

namespace corridor::learner {
namespace {

using bench::paper;

Batch random_batch(const NetworkShape& shape, int size) {
  const RowLayout layout{shape.observations};
  Batch batch;
  batch.observations = static_cast<std::uint32_t>(shape.observations);
  for (std::size_t i = 0; i < size * layout.stride(); ++i) {
    batch.rows.push_back(static_cast<float>(random_unit(1, Purpose::kBootstrap, {i})));
  }
  for (int i = 0; i < size; ++i) {
    batch.rows[i * layout.stride() + layout.action()] = static_cast<float>(i % shape.actions);
    batch.keys.push_back(static_cast<std::uint64_t>(i));
    batch.weights.push_back(1.0F);
  }
  return batch;
}

// Arguments: phase, batch.
NetworkShape shape_of(const benchmark::State& state) {
  return paper().network(static_cast<Phase>(state.range(0)));
}

void Floor(benchmark::State& state) {
  bench::TdFloor floor(shape_of(state), static_cast<int>(state.range(1)));
  for (auto _ : state) floor.step();
}

void Step(benchmark::State& state) {
  use_one_torch_thread();
  const NetworkShape shape = shape_of(state);
  const Batch batch = random_batch(shape, static_cast<int>(state.range(1)));
  const TdState initial = initial_td_state(initial_parameters(shape, 1, Phase::kMop));
  DqnSettings dqn = paper().phase(static_cast<Phase>(state.range(0)));
  dqn.risk_weight = 0.0;
  TdUpdate update(shape, dqn, Device::kCpu, initial);
  for (auto _ : state) benchmark::DoNotOptimize(update.update(batch, 1e-4));
}

// The same by LibTorch's autograd and its Adam over flat parameters: what CUDA runs.
void LibTorchStep(benchmark::State& state) {
  use_one_torch_thread();
  const NetworkShape shape = shape_of(state);
  const DqnSettings& dqn = paper().phase(static_cast<Phase>(state.range(0)));
  const Batch batch = random_batch(shape, static_cast<int>(state.range(1)));
  const TdState initial = initial_td_state(initial_parameters(shape, 1, Phase::kMop));
  const auto networks = torch_networks(shape, dqn, Device::kCpu, initial);
  for (auto _ : state) {
    const auto q = networks->forward(batch.rows, static_cast<int>(batch.weights.size()));
    const RowLayout layout{shape.observations};
    const TdLoss loss = td_loss(
        batch.rows, layout, {layout.n_step_return(), layout.discount()}, batch.weights, q,
        greedy_actions(q.online_next, {}, 0.0, shape.actions), shape.actions, dqn.huber_delta);
    benchmark::DoNotOptimize(networks->step(loss.q_gradient, 1e-4));
  }
}

void sizes(benchmark::internal::Benchmark* benchmark) {
  for (const Phase phase : {Phase::kMop, Phase::kBp}) {
    for (const int batch : {32, 64, 128, 512}) benchmark->Args({static_cast<int>(phase), batch});
  }
  benchmark->Unit(benchmark::kMicrosecond);
}
BENCHMARK(Floor)->Apply(sizes);
BENCHMARK(Step)->Apply(sizes);
BENCHMARK(LibTorchStep)->Apply(sizes);

}  // namespace
}  // namespace corridor::learner
