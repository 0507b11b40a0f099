// SPDX-License-Identifier: Apache-2.0
#include "cluster/train.h"

#include <algorithm>
#include <csignal>

#include "cluster/launch/describe_run.h"
#include "cluster/launch/local.h"
#include "cluster/launch/plan.h"
#include "cluster/launch/run_lock.h"
#include "cluster/watch/training_monitor.h"
#include "proto/base/failure.h"
#include "proto/base/json.h"
#include "proto/base/text.h"
#include "proto/config/config_values.h"
#include "proto/config/run_config.h"
#include "proto/run/checkpoints.h"
#include "proto/run/fingerprint.h"
#include "proto/run/manifest.h"
#include "proto/run/metrics.h"
#include "proto/run/networks.h"
#include "proto/run/run_directory.h"
#include "proto/settings/schedule.h"
#include "proto/system/clock.h"
#include "proto/system/files.h"
#include "proto/system/program.h"
#include "scenarios/sumo_files.h"

namespace corridor::cluster {
namespace {

// "MoP, round 24 of 80: 12,288 of 40,960 steps"
std::string position(const Schedule& schedule, std::uint64_t rounds_done) {
  const Phase phase = schedule.phase_of(rounds_done > 0 ? rounds_done - 1 : 0);
  return fmt::format(
      "{}, {} of {} rounds, {} of {} steps", phase_name(phase), rounds_done, schedule.rounds(),
      grouped(static_cast<std::int64_t>(rounds_done) * schedule.steps_per_round()),
      grouped(static_cast<std::int64_t>(schedule.rounds()) * schedule.steps_per_round()));
}

void print_what_comes_next(const RunDirectory& directory, const std::string& program) {
  const std::string run = directory.root().string();
  fmt::print(
      "  checkpoint    {0}/checkpoints\n"
      "  metrics       {0}/metrics\n"
      "  TensorBoard   {0}/tensorboard\n"
      "  logs          {0}/log\n"
      "Next:\n"
      "  {1} evaluate {0}\n"
      "  {1} fingerprint {0}\n",
      run, program);
}

// What nobody alive is writing any more; a line for each damaged checkpoint.
std::vector<std::string> clean_up(const RunDirectory& directory) {
  directory.remove_leftovers();
  return Checkpoints(directory.checkpoints()).set_aside_damaged();
}

// As its config.toml says, which all processes read.
int supervise(const RunDirectory& directory, std::uint64_t rounds_before,
              const std::string& program) {
  const RunConfig config = load_run_config(directory.config());
  const Schedule schedule(config);
  const double start_s = monotonic_s();
  TrainingMonitor monitor(schedule, config.run.actors, directory, rounds_before, available_cores(),
                          start_s);
  Limits limits;
  // Before others take it for lost.
  limits.hung = Milliseconds(static_cast<std::int64_t>(config.run.peer_timeout_s * 1000.0 * 2 / 3));
  Supervision supervision;
  supervision.tick = [&] { monitor.tick(monotonic_s()); };
  supervision.progress = [&] { return static_cast<std::uint64_t>(monitor.steps_done()); };
  supervision.died = [&](const Ended& ended, bool all) {
    if (!all) {
      monitor.announce(fmt::format("{}; started again", ended.cause()));
      return;
    }
    for (const std::string& line : clean_up(directory)) monitor.announce(line);
    const std::uint64_t rounds = rounds_done(directory);
    monitor.restarted(rounds, monotonic_s());
    monitor.announce(fmt::format("{}; all go on from {}", ended.cause(),
                                 rounds > 0 ? "the checkpoint of " + position(schedule, rounds)
                                            : std::string("the beginning")));
  };
  const int signal =
      run_together(training_plan(config.run, directory), kLearnerName, limits, supervision);
  monitor.tick(monotonic_s());

  const std::uint64_t rounds = rounds_done(directory);
  if (signal != 0) {
    fmt::print("stopped at the checkpoint of {}; resume with {} resume {}\n",
               position(schedule, rounds), program, directory.root().string());
    return 128 + signal;
  }
  CORRIDOR_CHECK(rounds == schedule.rounds(), "{} of {}", rounds, schedule.rounds());
  fmt::print("training is complete after {}: {}\n", duration_text(monotonic_s() - start_s),
             position(schedule, rounds));
  print_what_comes_next(directory, program);
  return 0;
}

// The settings to go on with, which config.toml then says.
RunConfig changed_config(const ResumeOptions& options, const RunDirectory& directory) {
  const RunConfig at_start = config_at_start(directory);
  RunConfig config = load_run_config(directory.config(), options.settings);
  const std::vector<ChangedKey> changed = changed_keys(at_start, config);
  for (const ChangedKey& key : changed) {
    if (!decides_result(key.heeds)) continue;
    throw Failure(
        "{} = {}: the run began with {}, and its result depends on it; put that back, or "
        "train anew",
        key.name, key.now, key.before);
  }
  for (const ChangedKey& key : changed) {
    fmt::print("{} = {}, where the run began with {}\n", key.name, key.now, key.before);
  }
  if (!options.settings.empty()) write_file(directory.config(), to_toml(config));
  return config;
}

}  // namespace

int train(const TrainOptions& options, const std::string& program) {
  std::vector<std::string> overrides;
  if (options.actors) overrides.push_back(fmt::format("run.actors={}", *options.actors));
  if (options.seed) overrides.push_back(fmt::format("run.seed={}", *options.seed));
  overrides.insert(overrides.end(), options.settings.begin(), options.settings.end());
  const RunConfig config = load_run_config(options.scenario, overrides);

  if (options.from.empty() && config.schedule.mop_commands == MopCommands::kLearned) {
    throw Failure(
        "schedule.mop_commands = \"learned\": there is no learned BP yet; begin with the networks "
        "of a run, as in --from runs/paper");
  }

  // Without its manifest, which comes last, the directory is no run.
  const RunDirectory directory = RunDirectory::create(options.run);
  FolderInTheMaking made(directory.root());
  const Descriptor lock = lock_run(directory);
  if (!options.from.empty()) {
    const RunDirectory trained = RunDirectory::open(options.from);
    const auto networks = newest_networks(trained, config);
    if (!networks) throw Failure("{} has no networks yet: train it first", options.from.string());
    write_networks(directory, *networks);
  }
  scenarios::write_sumo_files(config, directory.network().parent_path());
  const std::string text = to_toml(config);
  write_file(directory.config(), text);
  write_manifest(directory, describe_run(draw_run_id(), config.run.seed, options.scenario, text));
  if (stop_requested()) return 128 + SIGINT;
  made.keep();

  fmt::print("{}: {} actors, seed {}; logs in {}\n", directory.root().string(), config.run.actors,
             config.run.seed, (directory.root() / "log").string());
  return supervise(directory, 0, program);
}

int resume(const ResumeOptions& options, const std::string& program) {
  const RunDirectory directory = RunDirectory::open(options.run);
  if (read_manifest(directory).fingerprint) {
    throw Failure("{} is an exported run: train one with --from {} instead", options.run.string(),
                  options.run.string());
  }
  const Descriptor lock = lock_run(directory);
  directory.create_folders();
  const RunConfig config = changed_config(options, directory);
  for (const std::string& line : clean_up(directory)) {
    fmt::print("{}; the checkpoint before it is used\n", line);
  }
  const Schedule schedule(config);
  const std::string run = options.run.string();
  const std::uint64_t rounds = rounds_done(directory);
  if (rounds >= schedule.rounds()) {
    fmt::print("{} is complete: {}; nothing to resume\n", run, position(schedule, rounds));
    print_what_comes_next(directory, program);
    return 0;
  }
  const auto last = last_metrics_line(directory.metrics(kLearnerName));
  const std::uint64_t reached = last ? std::max(last->round + 1, rounds) : rounds;
  fmt::print("{}: {}: {}; {} steps after it are repeated\n", run,
             rounds > 0 ? "goes on from the checkpoint of" : "no checkpoint yet, begins anew",
             position(schedule, rounds),
             grouped(static_cast<std::int64_t>(reached - rounds) * schedule.steps_per_round()));
  return supervise(directory, rounds, program);
}

}  // namespace corridor::cluster
