#include "cluster/hindsight.h"

#include "cluster/evaluate.h"
#include "cluster/launch/local.h"
#include "cluster/launch/plan.h"
#include "cluster/results/hindsight_table.h"
#include "cluster/watch/line_tail.h"
#include "cluster/watch/step_progress.h"
#include "proto/base/failure.h"
#include "proto/config/run_config.h"
#include "proto/run/evaluation_record.h"
#include "proto/system/clock.h"

namespace corridor::cluster {
namespace {

EvaluationRecord evaluated(const EvaluationJob& job, const RunDirectory& directory) {
  const std::filesystem::path file = directory.evaluation(job.name());
  if (!std::filesystem::exists(file)) {
    throw Failure("{} has not been evaluated with {} on seed {}: corridor evaluate does that",
                  directory.root().string(), job.planner, job.seed);
  }
  return read_evaluation(file);
}

}  // namespace

int hindsight(const HindsightOptions& options) {
  const RunDirectory directory = RunDirectory::open(options.run);
  const RunConfig config = load_run_config(directory.config());
  const std::vector<EvaluationJob> jobs =
      chosen_jobs(options.planners, options.seeds, config.evaluation.steps, config);
  const int parallel = parallel_jobs(options.jobs);

  std::vector<EvaluationRecord> evaluations;
  std::vector<ProcessPlan> plan;
  std::vector<StepTask> tasks;
  for (const EvaluationJob& job : jobs) {
    evaluations.push_back(evaluated(job, directory));
    plan.push_back(hindsight_process(job, options.limits, directory, program_directory()));
    tasks.push_back({fmt::format("{} {}", job.planner, job.seed), evaluations.back().collisions, 0,
                     plan.back().log, parse_step_count});
  }
  StepProgress progress("hindsight", std::move(tasks), monotonic_s(), "collisions");
  const Ending ending = run_queue(plan, parallel, Limits{}, [&] { progress.tick(monotonic_s()); });
  if (ending.signal != 0) {
    fmt::print("stopped: no table\n");
    return 128 + ending.signal;
  }

  std::vector<HindsightRecord> results;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    const std::filesystem::path file = directory.hindsight(jobs[i].name());
    results.push_back(read_hindsight(file));
    if (results.back().steps != evaluations[i].steps ||
        std::ssize(results.back().collisions) != evaluations[i].collisions) {
      throw Failure("{} is not about what {} says now: has it been evaluated meanwhile? Try again",
                    file.string(), directory.evaluation(jobs[i].name()).string());
    }
  }
  fmt::print("\n{}\n\n{}", directory.root().string(), text_of(hindsight_table(results)));
  fmt::print("\neach collision in {}\n", directory.hindsight().string());
  return 0;
}

}  // namespace corridor::cluster
