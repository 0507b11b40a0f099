// SPDX-License-Identifier: Apache-2.0
// What an actor's step costs beside SUMO's own, part by part (proto/system/time_account.h).
#include <benchmark/benchmark.h>

#include <map>
#include <string>

#include "actor/driving/rules.h"
#include "actor/episode.h"
#include "actor/policy/action_values.h"
#include "actor/world/sumo_world.h"
#include "proto/settings/sumo_names.h"
#include "proto/system/time_account.h"
#include "scenarios/sumo_files.h"
#include "tests/bench/paper.h"
#include "tests/support/temporary_directory.h"

namespace corridor::actor {
namespace {

using bench::paper;

struct SumoFiles {
  SumoFiles() { scenarios::write_sumo_files(paper(), directory.path()); }
  testing_support::TemporaryDirectory directory;
};

// SUMO with the paper's road.
struct Place : SumoFiles {
  TimeAccount time;
  world::SumoWorld world{world::world_settings(paper()), directory.path() / kSumoNetworkFile,
                         directory.path() / kSumoRoutesFile, time};
};

void BeginEpisode(benchmark::State& state) {
  Place place;
  std::uint64_t seed = 0;
  for (auto _ : state) {
    place.world.begin({.seed = ++seed});
    place.world.end();
  }
}
BENCHMARK(BeginEpisode)->Unit(benchmark::kMillisecond);

// Episodes of the rules' planners: the traffic of an evaluation. The counters are shares of the
// time between SUMO's loads: simulate and traffic are what SUMO needs for the same traffic without
// an agent.
void Step(benchmark::State& state) {
  Place place;
  const DrivingSettings settings = driving_settings(paper());
  driving::RuleBasedBp bp(settings);
  driving::RuleBasedMop mop(settings);
  Episode episode(paper(), place.world);
  std::uint64_t seed = 0;
  bool ended = true;
  for (auto _ : state) {
    if (ended) {
      state.PauseTiming();
      episode.begin({.seed = ++seed});
      bp.begin_episode(seed);
      state.ResumeTiming();
    }
    const driving::Command command = bp.decide(episode.situation());
    const int action = mop.decide(episode.situation(), episode.window(command));
    ended = episode.step(command, action).episode_ended;
  }
  episode.end();
  double steps_share = 0.0;
  std::map<std::string, double> shares;
  for (const auto& [name, share] : place.time.take()) shares[name] = share;
  constexpr TimePart kParts[] = {TimePart::kSimulate, TimePart::kTraffic, TimePart::kWorld,
                                 TimePart::kPlan};
  for (const TimePart part : kParts) steps_share += shares[time_metric(part)];
  for (const TimePart part : kParts) {
    state.counters[time_part_name(part)] = shares[time_metric(part)] / steps_share;
  }
}
BENCHMARK(Step)->Unit(benchmark::kMicrosecond)->Iterations(20'000);

// A greedy choice of one planner.
void Infer(benchmark::State& state) {
  const auto phase = static_cast<Phase>(state.range(0));
  const PlannerShape shape = paper().shape(phase);
  policy::ActionValues planner(paper().phase(phase), shape,
                               std::vector<float>(paper().parameters(phase), 0.01F));
  const std::vector<float> observation(static_cast<std::size_t>(shape.observations), 0.5F);
  for (auto _ : state) benchmark::DoNotOptimize(planner.greedy(observation));
}
BENCHMARK(Infer)
    ->Arg(static_cast<int>(Phase::kMop))
    ->Arg(static_cast<int>(Phase::kBp))
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace corridor::actor
