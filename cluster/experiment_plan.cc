#include "cluster/experiment_plan.h"

#include "proto/base/format.h"
#include "proto/config/run_config.h"
#include "proto/settings/planner_pairs.h"

namespace corridor::cluster {

std::string TrainingRun::name() const { return fmt::format("{}-{}", training->name, seed); }

std::vector<TrainingRun> runs_of(const Experiment& experiment,
                                 const std::filesystem::path& directory) {
  std::vector<TrainingRun> runs;
  for (const TrainingArm& training : experiment.trainings) {
    for (const std::uint64_t seed : training.training_seeds) {
      std::vector<std::string> settings = training.settings;
      settings.push_back(fmt::format("run.seed={}", seed));
      TrainingRun run{&training, seed, {}, load_run_config(training.scenario, settings)};
      run.root = directory / "runs" / run.name();
      runs.push_back(std::move(run));
    }
  }
  return runs;
}

std::vector<std::string> train_command(const TrainingRun& run, const std::string& program) {
  std::vector<std::string> command = {
      program,           "train",  run.training->scenario.string(), "--run",
      run.root.string(), "--seed", std::to_string(run.seed)};
  for (const std::string& setting : run.training->settings) {
    command.insert(command.end(), {"--set", setting});
  }
  if (!run.training->from.empty()) {
    const std::string from = fmt::format("{}-{}", run.training->from, run.seed);
    command.insert(command.end(), {"--from", (run.root.parent_path() / from).string()});
  }
  return command;
}

std::vector<EvaluationJob> jobs_of(const TrainingRun& run, const Experiment& experiment,
                                   WorldKind world) {
  const bool first = run.seed == run.training->training_seeds.front();
  std::vector<std::string> planners;
  for (const std::string& planner : run.training->planners) {
    const PlannerPair& pair = planner_pair(planner);
    if ((pair.learned() || first) && pair.drives_in(world)) planners.push_back(planner);
  }
  return evaluation_jobs(planners, experiment.evaluation_seeds, experiment.evaluation_steps);
}

}  // namespace corridor::cluster
