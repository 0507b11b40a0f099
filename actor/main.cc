// SPDX-License-Identifier: Apache-2.0
// corridor-actor: one car in one SUMO. In a training it explores; by itself it evaluates, drives
// episodes again and for pictures, or looks back on an evaluation's collisions.
#include <cstdio>
#include <optional>

#include "actor/avoidance.h"
#include "actor/episode.h"
#include "actor/evaluation.h"
#include "actor/redrive.h"
#include "actor/rounds.h"
#include "actor/tracer.h"
#include "actor/world/sumo_world.h"
#include "proto/base/failure.h"
#include "proto/base/json.h"
#include "proto/config/run_config.h"
#include "proto/run/actor_task.h"
#include "proto/run/json_record.h"
#include "proto/run/manifest.h"
#include "proto/run/networks.h"
#include "proto/system/identity.h"
#include "proto/system/program.h"
#include "proto/system/test_delay.h"
#include "proto/system/time_account.h"

namespace {

using namespace corridor;

// Where all is driven.
struct Place {
  const RunDirectory& directory;
  const RunConfig& config;
  world::World& world;
  TimeAccount& time;
};

// Those that the pair drives with: of `from`, if given, else of the run.
Networks networks_for(const PlannerPair& pair, const std::optional<std::filesystem::path>& from,
                      const Place& place) {
  if (!pair.learned()) return {};
  const RunDirectory trained = from ? RunDirectory::open(*from) : place.directory;
  std::optional<Networks> networks = newest_networks(trained, place.config);
  if (!networks) {
    throw Failure("{} has no checkpoint yet: train on, or evaluate another run",
                  trained.root().string());
  }
  return *std::move(networks);
}

// Whether to go on.
bool tell_progress(std::int64_t done, std::int64_t total) {
  fmt::print("{}\n", step_count(done, total));
  std::fflush(stdout);
  return !stop_requested();
}

int perform(const TrainTask& task, const Place& place) {
  if (task.index < 0 || task.index >= place.config.run.actors) {
    throw Failure("--index {} is none of the run's {} actors", task.index, place.config.run.actors);
  }
  const ClientIdentity identity{read_manifest(place.directory).run_id, Role::kActor,
                                static_cast<std::uint32_t>(task.index), draw_incarnation()};
  actor::train(place.config, place.directory, identity, place.world, place.time, test_delay());
  return 0;
}

int perform(const EvaluateTask& task, const Place& place) {
  const Networks networks = networks_for(planner_pair(task.planner), task.networks, place);
  actor::evaluate(place.config, networks, task, place.directory, place.world,
                  [&](std::int64_t steps) { return tell_progress(steps, task.steps); });
  return 0;
}

int perform(const RedriveTask& task, const Place& place) {
  const actor::Redriven result = actor::redrive(place.config, task.episode, place.world,
                                                task.fcd.value_or(std::filesystem::path()));
  const actor::EpisodeSummary& summary = result.summary;
  fmt::print("{} steps, BP reward {:.1f}, {} lane changes, {}, trajectory {}: {}\n", summary.steps,
             summary.bp_reward, summary.lane_changes,
             summary.collision ? name_of(summary.collision->kind) : "no collision",
             result.trajectory_hash, result.as_recorded ? "as recorded" : "NOT as recorded");
  return result.as_recorded ? 0 : 1;
}

int perform(const TraceTask& task, const Place& place) {
  std::optional<Networks> networks;
  if (task.networks) networks = newest_networks(RunDirectory::open(*task.networks), place.config);
  const EpisodeTrace trace = actor::trace_episode(place.config, networks ? &*networks : nullptr,
                                                  task.episode, place.world);
  fmt::print("{}\n", json_of(trace).dump());
  return 0;
}

int perform(const DriveTask& task, const Place& place) {
  const PlannerPair& pair = planner_pair(task.planner);
  const EpisodeTrace trace =
      actor::trace_drive(place.config, networks_for(pair, task.networks, place), pair,
                         actor::test_episode_seed(task.seed, task.index), task.steps, place.world);
  fmt::print("{}\n", json_of(trace).dump());
  return 0;
}

int perform(const LookBackTask& task, const Place& place) {
  actor::report_hindsight(place.config, task, place.directory, place.world, tell_progress);
  return 0;
}

// Returns the exit status: 0, or 1 when an episode was driven again otherwise than recorded.
int perform(const ActorCommand& command) {
  const RunDirectory directory = RunDirectory::open(command.run);
  const RunConfig config = load_run_config(directory.config());
  TimeAccount time;
  world::SumoWorld world(world::world_settings(config), directory.network(), directory.routes(),
                         time);
  const Place place{directory, config, world, time};
  return std::visit([&](const auto& task) { return perform(task, place); }, command.task);
}

}  // namespace

int main(int argc, char** argv) {
  return run_program(kActorProgram, [&] {
    const auto asked = parse_actor_command(argc, argv);
    const auto* command = std::get_if<ActorCommand>(&asked);
    return command != nullptr ? perform(*command) : std::get<int>(asked);
  });
}
