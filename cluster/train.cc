// SPDX-License-Identifier: Apache-2.0
#include "cluster/train.h"

#include <algorithm>

#include "cluster/launch/local.h"
#include "cluster/launch/plan.h"
#include "cluster/launch/run_lock.h"
#include "cluster/watch/training_monitor.h"
#include "proto/base/failure.h"
#include "proto/base/json.h"
#include "proto/base/text.h"
#include "proto/config/config_values.h"
#include "proto/config/doubts.h"
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
#include "proto/system/processors.h"
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
      "  {1} evaluate {2}\n"
      "  {1} fingerprint {2}\n",
      run, shell_quoted(program), shell_quoted(run));
}

// What nobody alive is writing any more; a line for each damaged checkpoint.
std::vector<std::string> clean_up(const RunDirectory& directory) {
  directory.remove_leftovers();
  return Checkpoints(directory.checkpoints()).set_aside_damaged();
}

// Driven after the newest checkpoint, which has `rounds`.
std::int64_t steps_to_repeat(const RunDirectory& directory, const Schedule& schedule,
                             std::uint64_t rounds) {
  const auto last = last_metrics_line(directory.metrics(kLearnerName));
  const std::uint64_t reached = last ? std::max(last->round + 1, rounds) : rounds;
  return static_cast<std::int64_t>(reached - rounds) * schedule.steps_per_round();
}

// As its config.toml says, which all processes read.
int supervise(const RunDirectory& directory, std::uint64_t rounds_before, bool allow_other_bits,
              const std::string& program) {
  const RunConfig config = load_run_config(directory.config());
  const Schedule schedule(config);
  const double start_s = monotonic_s();
  TrainingMonitor monitor(schedule, config.run.actors, directory, rounds_before, available_cores(),
                          start_s);
  const Limits limits = limits_of(config);
  Supervision supervision;
  supervision.stopping = [&] {
    monitor.announce(
        "stopping: the learner ends its block and takes a checkpoint; a second signal ends all at "
        "once");
  };
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
  const int signal = run_together(training_plan(config.run, directory, allow_other_bits),
                                  kLearnerName, limits, supervision);
  monitor.tick(monotonic_s());

  const std::uint64_t rounds = rounds_done(directory);
  if (signal != 0) {
    fmt::print("{}; {} steps after it will be repeated; resume with {} resume {}\n",
               rounds > 0 ? "stopped at the checkpoint of " + position(schedule, rounds)
                          : std::string("stopped before the first checkpoint"),
               grouped(steps_to_repeat(directory, schedule, rounds)), shell_quoted(program),
               shell_quoted(directory.root().string()));
    return 128 + signal;
  }
  CORRIDOR_CHECK(rounds == schedule.rounds(), "{} of {}", rounds, schedule.rounds());
  fmt::print("training is complete after {}: {}\n", duration_text(monotonic_s() - start_s),
             position(schedule, rounds));
  print_what_comes_next(directory, program);
  return 0;
}

// Longer than it was to be, where no later phase has begun: what has been trained stays as it is.
bool goes_on_longer(const ChangedKey& key, const RunConfig& before, const RunConfig& now,
                    std::uint64_t rounds_done) {
  const Schedule schedule(before);
  for (const NamedNetwork& network : kNetworks) {
    const std::uint64_t end = schedule.first_round(network.id) + schedule.rounds_of(network.id);
    if (key.name != fmt::format("{}.steps", network.name)) continue;
    return now.phase(network.id).steps > before.phase(network.id).steps &&
           (rounds_done < end || end == schedule.rounds());
  }
  return false;
}

// What the run is asked to go on with otherwise than it was trained so far.
struct Changes {
  RunConfig config;
  std::vector<std::string> lines;  // of settings and libraries that its result depends on
};

void change_settings(const ResumeOptions& options, const RunDirectory& directory,
                     Changes& changes) {
  const RunConfig before = config_at_start(directory);
  RunConfig& config = changes.config;
  config = load_run_config(directory.config(), options.settings);
  const std::uint64_t done = rounds_done(directory);
  for (const ChangedKey& key : changed_keys(before, config)) {
    if (!decides_result(key.heeds)) {
      fmt::print("{} = {}, where the run began with {}\n", key.name, key.now, key.before);
    } else if (goes_on_longer(key, before, config, done)) {
      changes.lines.push_back(
          fmt::format("{} = {}, where it was {}", key.name, key.now, key.before));
    } else {
      throw Failure(
          "{} = {}: the run began with {}, and its result depends on it; put that back, or "
          "train anew",
          key.name, key.now, key.before);
    }
  }
  // What has come to its end stays there.
  for (const NamedNetwork& network : kNetworks) {
    DqnSettings& dqn = config.dqn[static_cast<std::size_t>(network.id)];
    const std::int64_t steps_before = before.phase(network.id).steps;
    if (dqn.steps > steps_before && dqn.annealing_steps == 0) dqn.annealing_steps = steps_before;
  }
}

void change_versions(const ResumeOptions& options, const RunManifest& manifest,
                     const RunVersions& here, Changes& changes) {
  const RunVersions& before = manifest.versions_now();
  for (std::string& line :
       allowed_changes(changed_versions(before, here), options.allow_other_bits)) {
    changes.lines.push_back(std::move(line));
  }
  if (before.git_commit == here.git_commit) return;
  fmt::print("corridor is of commit {}, where the run was trained with {}\n", here.git_commit,
             before.git_commit);
}

// The settings to go on with: config.toml then has them, the manifest what the bits depend on.
RunConfig changed_config(const ResumeOptions& options, const RunDirectory& directory,
                         RunVersions here) {
  RunManifest manifest = read_manifest(directory);
  // The learner compares these.
  here.blas_core = manifest.versions_now().blas_core;
  here.blas_config = manifest.versions_now().blas_config;
  Changes changes;
  change_settings(options, directory, changes);
  const bool longer = !changes.lines.empty();
  change_versions(options, manifest, here, changes);
  if (longer) {
    fmt::print(
        "the phase goes on: replay, optimiser and exploration as they are, learning rate and "
        "importance exponent at their ends. A run that was longer from the start would have had "
        "them higher until now, and would not have chosen its best networks, which go on, at the "
        "old end\n");
  }
  if (!options.settings.empty() || longer) {
    write_file(directory.config(), to_toml(changes.config));
  }
  if (changes.lines.empty()) return changes.config;
  for (const std::string& line : changes.lines) fmt::print("{}\n", line);
  manifest.config = to_toml(changes.config);
  manifest.go_on({rounds_done(directory), here, changes.lines});
  write_manifest(directory, manifest);
  return changes.config;
}

}  // namespace

int train(const TrainOptions& options, const std::string& program, const Versions& versions) {
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

  for (const std::string& doubt : doubts_about(config)) fmt::print("warning: {}\n", doubt);
  NewRun made(options.run);
  const Descriptor lock = lock_folder(made.directory().root());
  if (!options.from.empty()) {
    const RunDirectory trained = RunDirectory::open(options.from);
    const auto networks = newest_networks(trained, config);
    if (!networks) throw Failure("{} has no networks yet: train it first", options.from.string());
    write_networks(made.directory(), *networks);
  }
  scenarios::write_sumo_files(config, made.directory().network().parent_path());
  const std::string text = to_toml(config);
  write_file(made.directory().config(), text);
  write_manifest(made.directory(),
                 describe_run(draw_run_id(), config.run.seed, options.scenario, text, versions()));
  throw_if_stopped();
  if (!made.publish()) throw Failure("{} exists by now: choose another name", options.run.string());
  const RunDirectory directory = RunDirectory::open(options.run);

  fmt::print("{}: {} actors, seed {}; logs in {}\n", directory.root().string(), config.run.actors,
             config.run.seed, (directory.root() / "log").string());
  return supervise(directory, 0, /*allow_other_bits=*/false, program);
}

int resume(const ResumeOptions& options, const std::string& program, const Versions& versions) {
  const RunDirectory directory = RunDirectory::open(options.run);
  if (const auto manifest = read_manifest(directory); manifest.fingerprint || manifest.trained) {
    throw Failure("{} has no training to go on with, only networks: train one with --from {}",
                  options.run.string(), shell_quoted(options.run.string()));
  }
  const Descriptor lock = lock_folder(directory.root());
  directory.create_folders();
  const RunConfig config = changed_config(options, directory, versions());
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
  fmt::print("{}: {}: {}; {} steps after it are repeated\n", run,
             rounds > 0 ? "goes on from the checkpoint of" : "no checkpoint yet, begins anew",
             position(schedule, rounds), grouped(steps_to_repeat(directory, schedule, rounds)));
  return supervise(directory, rounds, options.allow_other_bits, program);
}

}  // namespace corridor::cluster
