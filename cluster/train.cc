#include "cluster/train.h"

#include <algorithm>
#include <chrono>
#include <csignal>

#include "cluster/launch/local.h"
#include "cluster/launch/manifest.h"
#include "cluster/launch/plan.h"
#include "cluster/launch/run_lock.h"
#include "cluster/new_run.h"
#include "cluster/watch/display.h"
#include "cluster/watch/line_tail.h"
#include "cluster/watch/tensorboard.h"
#include "cluster/watch/training_progress.h"
#include "cluster/watch/training_scalars.h"
#include "proto/base/failure.h"
#include "proto/base/json.h"
#include "proto/base/text.h"
#include "proto/config/config_values.h"
#include "proto/config/run_config.h"
#include "proto/run/checkpoints.h"
#include "proto/run/fingerprint.h"
#include "proto/run/metrics.h"
#include "proto/run/networks.h"
#include "proto/run/run_directory.h"
#include "proto/settings/schedule.h"
#include "proto/system/clock.h"
#include "proto/system/files.h"
#include "proto/system/program.h"

namespace corridor::cluster {
namespace {

// Seconds since 1970.
double wall_time_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

// Metrics files -> what people see, here and in TensorBoard.
class Monitor {
 public:
  Monitor(const RunConfig& config, const RunDirectory& directory, std::uint64_t rounds_done)
      : progress_(config, rounds_done, available_cores(), monotonic_s()),
        scalars_(config),
        learner_(directory.metrics(kLearnerName)),
        replay_(directory.metrics(kReplayName)) {
    for (int i = 0; i < config.run.actors; ++i) {
      actors_.emplace_back(directory.metrics(actor_name(i)));
    }
    write_events([&] {
      events_.emplace(directory.tensorboard(), wall_time_s());
      go_on_from(rounds_done);
    });
  }

  void announce(const std::string& line) { display_.announce(line); }
  std::int64_t steps_done() const { return progress_.steps_done(); }

  void tick() {
    const double now_s = monotonic_s();
    for_lines(learner_, [&](const MetricsLine& line) {
      progress_.on_learner(line, now_s);
      scalars_.on_learner(line);
    });
    for_lines(replay_, [&](const MetricsLine& line) {
      progress_.on_replay(line);
      scalars_.on_replay(line);
    });
    for (std::size_t i = 0; i < actors_.size(); ++i) {
      for_lines(actors_[i], [&](const MetricsLine& line) {
        progress_.on_actor(line);
        scalars_.on_actor(static_cast<int>(i), line);
      });
    }
    const std::vector<StepScalars> ready = scalars_.take();
    write_events([&] {
      for (const StepScalars& at : ready) events_->write(at.step, at.values, wall_time_s());
    });
    if (display_.due(now_s)) display_.show(progress_.lines(), now_s);
  }

  // All processes have ended, and others go on from there.
  void restarted(std::uint64_t rounds_done) {
    tick();
    write_events([&] { go_on_from(rounds_done); });
  }

 private:
  template <typename Action>
  static void for_lines(LineTail& tail, const Action& action) {
    for (const std::string& text : tail.read()) {
      if (const auto line = parse_metrics_line(text)) action(*line);
    }
  }

  void go_on_from(std::uint64_t rounds_done) {
    const std::int64_t steps = scalars_.steps_before(rounds_done);
    scalars_.go_back_to(steps);
    events_->start(steps + 1, wall_time_s());
  }

  // No training ends because its events cannot be written.
  template <typename Action>
  void write_events(const Action& action) {
    if (events_given_up_) return;
    try {
      action();
    } catch (const Failure& failure) {
      events_given_up_ = true;
      announce(
          fmt::format("{}; the training goes on without events for TensorBoard", failure.what()));
    }
  }

  TrainingProgress progress_;
  TrainingScalars scalars_;
  std::optional<EventWriter> events_;
  bool events_given_up_ = false;
  LineTail learner_;
  LineTail replay_;
  std::vector<LineTail> actors_;
  ProgressDisplay display_;
};

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

int supervise(const RunConfig& config, const RunDirectory& directory, std::uint64_t rounds_before,
              const std::string& program) {
  const Schedule schedule(config);
  const double start_s = monotonic_s();
  Monitor monitor(config, directory, rounds_before);
  Limits limits;
  // Before others take it for lost.
  limits.hung = Milliseconds(static_cast<std::int64_t>(config.run.peer_timeout_s * 1000.0 * 2 / 3));
  Supervision supervision;
  supervision.tick = [&] { monitor.tick(); };
  supervision.progress = [&] { return static_cast<std::uint64_t>(monitor.steps_done()); };
  supervision.died = [&](const Ended& ended, bool all) {
    if (!all) {
      monitor.announce(fmt::format("{}; started again", ended.cause()));
      return;
    }
    for (const std::string& line : clean_up(directory)) monitor.announce(line);
    const std::uint64_t rounds = rounds_done(directory);
    monitor.restarted(rounds);
    monitor.announce(fmt::format("{}; all go on from {}", ended.cause(),
                                 rounds > 0 ? "the checkpoint of " + position(schedule, rounds)
                                            : std::string("the beginning")));
  };
  const Ending ending = run_together(training_plan(config.run, directory, program_directory()),
                                     kLearnerName, limits, supervision);
  monitor.tick();

  const std::uint64_t rounds = rounds_done(directory);
  if (ending.signal != 0) {
    fmt::print("stopped at the checkpoint of {}; resume with {} resume {}\n",
               position(schedule, rounds), program, directory.root().string());
    return 128 + ending.signal;
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
  const RunConfig config = load_run_config(directory.config(), options.settings);
  for (const ChangedKey& key : changed_keys(at_start, config)) {
    if (!decides_result(key.heeds)) continue;
    throw Failure(
        "{} = {}: the run began with {}, and its result depends on it; put that back, or "
        "train anew",
        key.name, key.now, key.before);
  }
  for (const ChangedKey& key : changed_keys(at_start, config)) {
    fmt::print("{} = {}, where the run began with {}\n", key.name, key.now, key.before);
  }
  if (!options.settings.empty()) write_file(directory.config(), to_toml(config));
  return config;
}

std::optional<Networks> networks_to_begin_with(const std::filesystem::path& from,
                                               const RunConfig& config) {
  if (from.empty()) {
    if (config.schedule.mop_commands == MopCommands::kRandom) return std::nullopt;
    throw Failure(
        "schedule.mop_commands = \"learned\": there is no learned BP yet; begin with the networks "
        "of a run, as in --from runs/paper");
  }
  const auto networks = newest_networks(RunDirectory::open(from), config);
  if (!networks) throw Failure("{} has no networks yet: train it first", from.string());
  return networks;
}

}  // namespace

int train(const TrainOptions& options, const std::string& program) {
  std::vector<std::string> overrides;
  if (options.actors) overrides.push_back(fmt::format("run.actors={}", *options.actors));
  if (options.seed) overrides.push_back(fmt::format("run.seed={}", *options.seed));
  overrides.insert(overrides.end(), options.settings.begin(), options.settings.end());
  const RunConfig config = load_run_config(options.scenario, overrides);

  const std::optional<Networks> given = networks_to_begin_with(options.from, config);

  NewRun run(options.run);
  const RunDirectory& directory = run.directory();
  const RunLock lock(directory);
  if (given) write_networks(directory, *given);
  const std::string text = to_toml(config);
  run.fill(config, text, describe_run(draw_run_id(), config.run.seed, options.scenario, text));
  if (stop_requested()) return 128 + SIGINT;
  run.keep();

  fmt::print("{}: {} actors, seed {}; logs in {}\n", directory.root().string(), config.run.actors,
             config.run.seed, (directory.root() / "log").string());
  return supervise(config, directory, 0, program);
}

int resume(const ResumeOptions& options, const std::string& program) {
  const RunDirectory directory = RunDirectory::open(options.run);
  if (read_manifest(directory).fingerprint) {
    throw Failure("{} is an exported run: train one with --from {} instead", options.run.string(),
                  options.run.string());
  }
  const RunLock lock(directory);
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
  return supervise(config, directory, rounds, program);
}

}  // namespace corridor::cluster
