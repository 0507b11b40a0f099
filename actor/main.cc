// corridor-actor: one car in one SUMO. In a training run it explores; by itself it evaluates,
// drives a recorded episode again, for its figures too, or looks back on an evaluation's
// collisions.
#include <cstdio>
#include <optional>
#include <string>

#include "actor/episode.h"
#include "actor/evaluation.h"
#include "actor/look_back.h"
#include "actor/rounds.h"
#include "actor/tracer.h"
#include "actor/world/sumo_world.h"
#include "proto/base/failure.h"
#include "proto/config/run_config.h"
#include "proto/run/networks.h"
#include "proto/run/run_directory.h"
#include "proto/settings/collision_kinds.h"
#include "proto/system/command_line.h"
#include "proto/system/identity.h"
#include "proto/system/program.h"
#include "proto/system/test_delay.h"
#include "proto/system/time_account.h"

namespace {

using namespace corridor;

struct Arguments {
  std::string run;
  int index = -1;
  std::string planners;
  std::uint64_t seed = 0;
  std::int64_t steps = 0;
  std::string networks;
  std::string fcd;
  std::string episode;
  std::string trace;
  std::string drive;
  std::uint64_t of_seed = 0;
  std::string look_back;
  actor::HindsightLimits hindsight;
};

// Those that the pair drives with.
Networks networks_for(const Arguments& arguments, const PlannerPair& pair, const RunConfig& config,
                      const RunDirectory& directory) {
  if (!pair.learned()) return {};
  const RunDirectory trained =
      arguments.networks.empty() ? directory : RunDirectory::open(arguments.networks);
  std::optional<Networks> networks = newest_networks(trained, config);
  if (!networks) {
    throw Failure("{} has no checkpoint yet: train on, or evaluate another run",
                  trained.root().string());
  }
  return *std::move(networks);
}

int evaluate(const Arguments& arguments, const RunConfig& config, const RunDirectory& directory,
             world::World& world) {
  const actor::EvaluationTask task{planner_pair(arguments.planners), arguments.seed,
                                   arguments.steps, arguments.fcd};
  const Networks networks = networks_for(arguments, task.pair, config, directory);
  actor::evaluate(config, networks, task, directory, world, [&](std::int64_t steps) {
    std::printf("%lld/%lld\n", static_cast<long long>(steps), static_cast<long long>(task.steps));
    std::fflush(stdout);
    return !stop_requested();
  });
  return 0;
}

int redrive(const Arguments& arguments, const RunConfig& config, world::World& world) {
  const actor::Redriven result = actor::redrive(config, arguments.episode, world, arguments.fcd);
  const auto& summary = result.summary;
  std::printf("%d steps, BP reward %.1f, %d lane changes, %s, trajectory %016llx: %s\n",
              summary.steps, summary.bp_reward, summary.lane_changes,
              summary.collision ? name_of(summary.collision->kind) : "no collision",
              static_cast<unsigned long long>(result.hash),
              result.hash == result.recorded_hash ? "as recorded" : "NOT as recorded");
  return result.hash == result.recorded_hash ? 0 : 1;
}

int trace(const Arguments& arguments, const RunConfig& config, world::World& world) {
  std::optional<Networks> networks;
  if (!arguments.networks.empty()) {
    networks = newest_networks(RunDirectory::open(arguments.networks), config);
  }
  const EpisodeTrace trace =
      actor::trace_episode(config, networks ? &*networks : nullptr, arguments.trace, world);
  std::puts(to_json(trace).dump().c_str());
  return 0;
}

int drive(const Arguments& arguments, const RunConfig& config, const RunDirectory& directory,
          world::World& world) {
  const PlannerPair& pair = planner_pair(arguments.drive);
  const EpisodeTrace trace = actor::trace_drive(
      config, networks_for(arguments, pair, config, directory), pair,
      actor::test_episode_seed(arguments.seed, arguments.of_seed), arguments.steps, world);
  std::puts(to_json(trace).dump().c_str());
  return 0;
}

int look_back(const Arguments& arguments, const RunConfig& config, const RunDirectory& directory,
              world::World& world) {
  const actor::HindsightTask task{arguments.look_back, arguments.seed, arguments.hindsight};
  actor::report_hindsight(config, task, directory, world, [](std::size_t done, std::size_t total) {
    std::printf("%zu/%zu\n", done, total);
    std::fflush(stdout);
    return !stop_requested();
  });
  return 0;
}

int run(const Arguments& arguments) {
  const RunDirectory directory = RunDirectory::open(arguments.run);
  const RunConfig config = load_run_config(directory.config());
  TimeAccount time;
  world::SumoWorld world(world::world_settings(config), directory.network(), directory.routes(),
                         time);
  if (!arguments.episode.empty()) return redrive(arguments, config, world);
  if (!arguments.trace.empty()) return trace(arguments, config, world);
  if (!arguments.drive.empty()) return drive(arguments, config, directory, world);
  if (!arguments.look_back.empty()) return look_back(arguments, config, directory, world);
  if (!arguments.planners.empty()) return evaluate(arguments, config, directory, world);
  if (arguments.index < 0 || arguments.index >= config.run.actors) {
    throw Failure("--index {} is none of the run's {} actors", arguments.index, config.run.actors);
  }
  const ClientIdentity identity{read_manifest(directory).run_id, Role::kActor,
                                static_cast<std::uint32_t>(arguments.index), draw_incarnation()};
  actor::train(config, directory, identity, world, time, test_delay());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("One car in one SUMO: an actor of a training run, or an evaluation by itself");
  app.add_option("RUN", arguments.run, "run directory")->required();
  app.add_option("--index", arguments.index, "train: as which actor, from 0");
  app.add_option("--evaluate", arguments.planners, "evaluate this planner pair");
  app.add_option("--seed", arguments.seed, "evaluate, look back: seed of the traffic");
  app.add_option("--steps", arguments.steps, "evaluate: steps to drive");
  app.add_option("--networks", arguments.networks,
                 "evaluate, drive, trace: run directory whose networks drive, if not RUN");
  app.add_option("--fcd", arguments.fcd,
                 "SUMO writes its trajectories here (evaluate: a directory; redrive: a file)");
  app.add_option("--redrive", arguments.episode, "drive this recorded episode again");
  app.add_option("--trace", arguments.trace,
                 "drive this recorded episode again and print every step as JSON");
  app.add_option("--drive", arguments.drive,
                 "drive this planner pair in an episode of the seed and print every step as JSON");
  app.add_option("--of-seed", arguments.of_seed, "drive: which episode of the seed, from 0");
  app.add_option("--look-back", arguments.look_back,
                 "search how this planner pair's collisions in an evaluation could be avoided");
  app.add_option("--actions", arguments.hindsight.actions, "look back: by the last so many actions")
      ->check(CLI::Range(1, 10));
  app.add_option("--attempts", arguments.hindsight.attempts_max,
                 "look back: give up after so many attempts for each number of actions")
      ->check(CLI::PositiveNumber);
  return run_program("corridor-actor", [&] {
    const auto done = parse_command_line(app, "corridor-actor", argc, argv);
    return done ? *done : run(arguments);
  });
}
