// SPDX-License-Identifier: Apache-2.0
#include "cluster/hindsight.h"

#include "cluster/evaluate.h"
#include "cluster/evaluation_world.h"
#include "cluster/launch/local.h"
#include "cluster/launch/plan.h"
#include "cluster/results/results_tables.h"
#include "cluster/watch/step_progress.h"
#include "proto/base/failure.h"
#include "proto/run/evaluation_record.h"
#include "proto/run/manifest.h"
#include "proto/system/clock.h"

namespace corridor::cluster {
namespace {

EvaluationRecord evaluated(const EvaluateTask& task, const RunDirectory& directory) {
  const std::filesystem::path file = directory.evaluation({task.planner, task.seed});
  if (!std::filesystem::exists(file)) {
    throw Failure("{} has not been evaluated with {} on seed {}: corridor evaluate does that",
                  directory.root().string(), task.planner, task.seed);
  }
  return read_evaluation(file);
}

}  // namespace

int hindsight(const HindsightOptions& options) {
  // An evaluation lies where its results went, an exported run's not in the run.
  const RunDirectory evaluation = open_results(options.run);
  const auto [trained, directory, config] =
      evaluation_place(evaluation.root(), EvaluationWorld{}, options.out);
  const std::vector<EvaluateTask> tasks =
      chosen_tasks(options.planners, options.seeds, config.evaluation.steps, config);
  const int parallel = parallel_jobs(options.jobs);

  std::vector<EvaluationRecord> evaluations;
  std::vector<ProcessPlan> plan;
  std::vector<StepTask> shown;
  for (const EvaluateTask& asked : tasks) {
    LookBackTask task{asked.planner, asked.seed, options.limits};
    if (!options.out.empty()) task.evaluated = evaluation.root();
    evaluations.push_back(evaluated(asked, evaluation));
    plan.push_back(
        actor_process(fmt::format("hindsight-{}-{}", task.planner, task.seed), task, directory));
    shown.push_back({fmt::format("{} {}", task.planner, task.seed), evaluations.back().collisions,
                     0, plan.back().log, parse_step_count});
  }
  StepProgress progress("hindsight", std::move(shown), monotonic_s(), "collisions");
  const int signal =
      run_queue(plan, parallel, limits_of(config), [&] { progress.tick(monotonic_s()); });
  if (signal != 0) {
    fmt::print("stopped: no table\n");
    return 128 + signal;
  }

  std::vector<HindsightRecord> results;
  for (const EvaluationRecord& of : evaluations) {
    const EvaluationName name = of.name();
    results.push_back(read_hindsight(directory.hindsight(name)));
    if (results.back().steps != of.steps ||
        std::ssize(results.back().collisions) != of.collisions) {
      throw Failure("{} is not about what {} says now: has it been evaluated meanwhile? Try again",
                    directory.hindsight(name).string(), evaluation.evaluation(name).string());
    }
  }
  fmt::print("\n{}\n\n{}", directory.root().string(), text_of(hindsight_table(results)));
  fmt::print("\neach collision in {}\n", directory.hindsight().string());
  return 0;
}

}  // namespace corridor::cluster
