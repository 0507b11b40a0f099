// SPDX-License-Identifier: Apache-2.0
#include "cluster/experiment.h"

#include <algorithm>
#include <vector>

#include "cluster/evaluate.h"
#include "cluster/experiment_file.h"
#include "cluster/launch/describe_run.h"
#include "cluster/launch/local.h"
#include "cluster/launch/plan.h"
#include "cluster/launch/run_lock.h"
#include "cluster/results/results_tables.h"
#include "cluster/watch/step_progress.h"
#include "proto/base/failure.h"
#include "proto/base/json.h"
#include "proto/base/text.h"
#include "proto/config/config_values.h"
#include "proto/config/run_config.h"
#include "proto/run/evaluation_record.h"
#include "proto/run/fingerprint.h"
#include "proto/run/metrics.h"
#include "proto/run/run_directory.h"
#include "proto/settings/schedule.h"
#include "proto/system/clock.h"
#include "proto/system/files.h"

namespace corridor::cluster {
namespace {

namespace fs = std::filesystem;

constexpr int kCoresPerTraining = 2;

// One evaluation of one run's networks in one scenario.
struct Evaluation {
  const TrainingRun* run = nullptr;
  std::string world;   // its name
  RunDirectory place;  // of that scenario
  EvaluateTask task;
};

// Of runs that have been trained.
std::vector<Evaluation> evaluations_of(const Experiment& experiment,
                                       const std::vector<TrainingRun>& runs) {
  std::vector<Evaluation> evaluations;
  for (const TrainingRun& run : runs) {
    for (const EvaluationWorld& world : run.training->evaluate_in) {
      const EvaluationPlace place = evaluation_place(run.root, world);
      for (EvaluateTask& task : tasks_of(run, experiment, place.config.dynamics.world)) {
        evaluations.push_back({&run, world.name(""), place.directory, std::move(task)});
      }
    }
  }
  return evaluations;
}

bool has_begun(const TrainingRun& run) { return fs::exists(run.root / kManifestFile); }

// The directory of this experiment, new or of an earlier start.
void claim(const fs::path& directory, const fs::path& file) {
  constexpr const char* kFolders[] = {"runs", "log"};
  const fs::path copy = directory / "experiment.toml";
  if (!fs::exists(copy)) {
    if (fs::exists(directory) && !is_empty_folder(directory)) {
      throw Failure("{} has something else than an experiment in it: choose another directory",
                    directory.string());
    }
    create_folders(directory);
    write_file(copy, read_file(file));
  } else if (read_file(copy) != read_file(file)) {
    throw Failure("{} holds another experiment than {}: choose another directory, or put {} back",
                  directory.string(), file.string(), copy.string());
  }
  create_folders(directory, kFolders);
}

void check_same_settings(const TrainingRun& run) {
  for (const ChangedKey& key :
       changed_keys(config_at_start(RunDirectory::open(run.root)), run.config)) {
    if (!decides_result(key.heeds)) continue;
    throw Failure("{} was trained with {} = {}, where {} now says {}: move it away to train anew",
                  run.root.string(), key.name, key.before, run.training->scenario.string(),
                  key.now);
  }
}

ProcessPlan training_process(const TrainingRun& run, const fs::path& log) {
  const std::string program = program_path("corridor");
  if (has_begun(run)) return {run.name(), {program, "resume", run.root.string()}, log};
  return {run.name(), train_command(run, program), log};
}

// Both return the signal that stopped them, or 0.
int train_all(const std::vector<TrainingRun>& runs, const fs::path& directory, int cores) {
  std::vector<ProcessPlan> plan;
  std::vector<ProcessPlan> later;  // those that begin with what is trained first
  std::vector<StepTask> tasks;
  for (const TrainingRun& run : runs) {
    if (has_begun(run)) check_same_settings(run);
    const Schedule schedule(run.config);
    const auto steps = [per_round = schedule.steps_per_round()](std::uint64_t rounds) {
      return static_cast<std::int64_t>(rounds) * per_round;
    };
    const std::uint64_t done = has_begun(run) ? rounds_done(RunDirectory::open(run.root)) : 0;
    tasks.push_back({run.name(), steps(schedule.rounds()), steps(done),
                     run.root / "metrics" / "learner.jsonl", [steps](std::string_view text) {
                       const auto line = parse_metrics_line(text);
                       return line ? std::optional(steps(line->round + 1)) : std::nullopt;
                     }});
    if (done < schedule.rounds()) {
      (run.training->from.empty() ? plan : later)
          .push_back(training_process(run, directory / "log" / (run.name() + ".log")));
    }
  }
  Limits limits;
  // Each of them ends processes of its own, after a checkpoint. It is they who see who hangs.
  limits.others = Milliseconds(120'000);
  limits.repeated_signal = Milliseconds(1000);
  StepProgress progress("training", std::move(tasks), monotonic_s());
  for (const auto& queue : {plan, later}) {
    const int signal = run_queue(queue, std::max(1, cores / kCoresPerTraining), limits,
                                 [&] { progress.tick(monotonic_s()); });
    if (signal != 0) return signal;
  }
  return 0;
}

int evaluate_all(const std::vector<Evaluation>& evaluations, const fs::path& directory, int cores) {
  std::vector<ProcessPlan> plan;
  std::vector<StepTask> tasks;
  for (const auto& [run, world, place, task] : evaluations) {
    ProcessPlan process = actor_process(
        fmt::format("{}-{}-{}-{}", run->name(), world, task.planner, task.seed), task, place);
    process.log = directory / "log" / (process.name + ".log");
    const fs::path file = place.evaluation({task.planner, task.seed});
    const bool done = fs::exists(file) && read_evaluation(file).steps == task.steps;
    tasks.push_back(
        {process.name, task.steps, done ? task.steps : 0, process.log, parse_step_count});
    if (!done) plan.push_back(std::move(process));
  }
  StepProgress progress("evaluation", std::move(tasks), monotonic_s());
  return run_queue(plan, cores, Limits{}, [&] { progress.tick(monotonic_s()); });
}

// All results of one training in one scenario.
std::vector<SeedResult> results_in(const std::vector<Evaluation>& evaluations,
                                   const TrainingArm& training, const std::string& world) {
  std::vector<SeedResult> results;
  for (const Evaluation& evaluation : evaluations) {
    if (evaluation.run->training != &training || evaluation.world != world) continue;
    const auto file = evaluation.place.evaluation({evaluation.task.planner, evaluation.task.seed});
    results.push_back({evaluation.run->seed, read_evaluation(file)});
  }
  return results;
}

// Of one training's evaluations in a world.
RunConfig config_of(const std::vector<Evaluation>& evaluations, const TrainingArm& training,
                    const std::string& world) {
  const auto one = std::ranges::find_if(evaluations, [&](const Evaluation& evaluation) {
    return evaluation.run->training == &training && evaluation.world == world;
  });
  CORRIDOR_CHECK(one != evaluations.end(), "{} in {}", training.name, world);
  return load_run_config(one->place.config());
}

Table runs_table(const std::vector<TrainingRun>& runs) {
  Table table{"Training runs", {"run", "scenario", "training seed", "settings", "fingerprint"}, {}};
  for (const TrainingRun& run : runs) {
    const std::string settings = listed(run.training->settings);
    const auto checkpoint = Checkpoints(RunDirectory::open(run.root).checkpoints()).newest();
    CORRIDOR_CHECK(checkpoint.has_value(), "{}", run.root.string());
    table.rows.push_back({{run.name()},
                          {run.training->scenario.filename().string()},
                          {std::to_string(run.seed)},
                          {settings.empty() ? "-" : settings},
                          {fingerprint(*checkpoint)}});
  }
  return table;
}

void write_results(const Experiment& experiment, const std::vector<TrainingRun>& runs,
                   const std::vector<Evaluation>& evaluations, const ExperimentOptions& options) {
  std::string text =
      fmt::format("# {}\n\n{} steps for each arm, training seed and evaluation seed.\n",
                  options.file.filename().string(), grouped(experiment.evaluation_steps));
  OrderedJson json = OrderedJson::array();
  for (const TrainingArm& training : experiment.trainings) {
    for (const EvaluationWorld& evaluated : training.evaluate_in) {
      const std::string world = evaluated.name("");
      const std::vector<SeedResult> results = results_in(evaluations, training, world);
      const std::vector<Table> tables = results_tables(arms_of(results));
      const std::string title = fmt::format("{}, evaluated in {}", training.name, world);
      text += fmt::format("\n## {}\n\n{}\n", title,
                          world_text(config_of(evaluations, training, world)));
      for (const Table& table : tables) text += fmt::format("\n{}", markdown_of(table));
      fmt::print("\n{}\n{}", title, text_of(tables.front()));
      for (const SeedResult& result : results) {
        OrderedJson entry = {
            {"training", training.name}, {"training_seed", result.training_seed}, {"world", world}};
        entry.update(totals_json(result.result));
        json.push_back(std::move(entry));
      }
    }
  }
  text +=
      fmt::format("\n## Runs\n\n{}\n{}", markdown_of(runs_table(runs)), markdown_of(paper_table()));
  write_file(options.directory / "results.md", text);
  write_file(options.directory / "results.json", json.dump(1) + "\n");
}

}  // namespace

int experiment(const ExperimentOptions& options, const std::string& program) {
  const Experiment experiment = load_experiment(options.file);
  const int cores = parallel_jobs(options.jobs);
  claim(options.directory, options.file);
  const Descriptor lock = lock_folder(options.directory);
  const std::vector<TrainingRun> runs = runs_of(experiment, options.directory);

  int signal = train_all(runs, options.directory, cores);
  std::vector<Evaluation> evaluations;
  if (signal == 0) {
    evaluations = evaluations_of(experiment, runs);
    signal = evaluate_all(evaluations, options.directory, cores);
  }
  if (signal != 0) {
    fmt::print("stopped; go on with the same command: {} experiment {} --run {}\n",
               shell_quoted(program), shell_quoted(options.file.string()),
               shell_quoted(options.directory.string()));
    return 128 + signal;
  }
  write_results(experiment, runs, evaluations, options);
  fmt::print("\nall tables in {}\n", (options.directory / "results.md").string());
  return 0;
}

}  // namespace corridor::cluster
