// SPDX-License-Identifier: Apache-2.0
#include "cluster/evaluate.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "cluster/launch/local.h"
#include "cluster/launch/plan.h"
#include "cluster/results/results_tables.h"
#include "cluster/watch/step_progress.h"
#include "proto/base/failure.h"
#include "proto/base/json.h"
#include "proto/base/text.h"
#include "proto/run/evaluation_record.h"
#include "proto/settings/planner_pairs.h"
#include "proto/system/clock.h"
#include "proto/system/files.h"
#include "proto/system/processors.h"
#include "proto/system/subprocess.h"

namespace corridor::cluster {
namespace {

template <typename T>
void refuse_repeated(std::vector<T> values, const char* what) {
  std::sort(values.begin(), values.end());
  const auto repeated = std::adjacent_find(values.begin(), values.end());
  if (repeated != values.end()) throw Failure("{} {} is given twice", what, *repeated);
}

}  // namespace

std::vector<EvaluateTask> chosen_tasks(std::vector<std::string> planners,
                                       std::vector<std::uint64_t> seeds, std::int64_t steps,
                                       const RunConfig& config) {
  if (planners.empty()) {
    for (const PlannerPair& pair : kPlannerPairs) {
      if (pair.by_default) planners.emplace_back(pair.name);
    }
  }
  if (seeds.empty()) seeds = config.evaluation.seeds;
  for (const std::string& planner : planners) planner_pair(planner);
  refuse_repeated(planners, "planner");
  refuse_repeated(seeds, "evaluation seed");
  return evaluation_tasks(planners, seeds, steps);
}

int parallel_jobs(std::optional<int> jobs) {
  const int parallel = jobs.value_or(available_cores());
  if (parallel < 1) throw Failure("--jobs {}: at least 1 is needed", parallel);
  return parallel;
}

int evaluate(const EvaluateOptions& options) {
  std::optional<OutputFile> json;
  if (!options.json.empty()) json.emplace(options.json);
  // Nothing else comes where JSON is to.
  std::FILE* const out = json && json->is_standard_output() ? stderr : stdout;
  const EvaluationPlace place = evaluation_place(options.run, options.world, options.out);
  const auto& [trained, directory, config] = place;
  const std::int64_t steps = options.steps.value_or(config.evaluation.steps);
  if (steps < 1) throw Failure("--steps {}: at least 1 is needed", steps);
  const std::vector<EvaluateTask> tasks =
      chosen_tasks(options.planners, options.seeds, steps, config);
  for (const EvaluateTask& task : tasks) check_can_drive(task.planner, place);
  const int parallel = parallel_jobs(options.jobs);

  std::vector<ProcessPlan> plan;
  std::vector<StepTask> shown;
  for (EvaluateTask task : tasks) {
    if (directory.root() != trained.root()) task.networks = trained.root();
    if (!options.fcd.empty()) task.fcd = options.fcd;
    plan.push_back(
        actor_process(fmt::format("evaluate-{}-{}", task.planner, task.seed), task, directory));
    shown.push_back({fmt::format("{} {}", task.planner, task.seed), steps, 0, plan.back().log,
                     parse_step_count});
  }
  int signal = 0;
  {
    StepProgress progress("evaluation", std::move(shown), monotonic_s(), "steps", out);
    signal = run_queue(plan, parallel, limits_of(config), [&] { progress.tick(monotonic_s()); });
  }
  if (signal != 0) {
    fmt::print(out, "stopped: no table\n");
    return 128 + signal;
  }

  std::vector<EvaluationRecord> results;
  std::vector<SeedResult> of_this_run;
  for (const EvaluateTask& task : tasks) {
    results.push_back(read_evaluation(directory.evaluation({task.planner, task.seed})));
    of_this_run.push_back({config.run.seed, results.back()});
  }
  fmt::print(out, "\n{}: {} steps for each planner and seed\n{}\n", directory.root().string(),
             grouped(steps), world_text(config));
  for (const Table& table : results_tables(arms_of(of_this_run))) {
    fmt::print(out, "\n{}", text_of(table));
  }
  fmt::print(out, "\n{}", text_of(paper_table()));
  if (json) {
    OrderedJson totals = OrderedJson::array();
    for (const EvaluationRecord& result : results) totals.push_back(totals_json(result));
    json->write(totals.dump(2) + "\n");
  }
  fmt::print(out, "\nepisodes in {}; drive one again with corridor redrive {}\n",
             directory.episodes().string(), shell_quoted(directory.root().string()));
  return 0;
}

void redrive(const std::filesystem::path& run, const std::string& episode) {
  const RunDirectory directory = RunDirectory::open(run);
  ProcessPlan actor =
      actor_process("redrive", RedriveTask{find_episode(directory, episode)}, directory);
  const std::vector<char*> argv = pointers_to(actor.argv);
  execv(argv[0], argv.data());
  throw Failure("cannot start {}: {}; is the build complete?", argv[0], std::strerror(errno));
}

}  // namespace corridor::cluster
