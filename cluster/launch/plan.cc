#include "cluster/launch/plan.h"

#include "proto/base/format.h"

namespace corridor::cluster {
namespace {

ProcessPlan actor_process(const std::string& name, const ActorTask& task,
                          const RunDirectory& directory, const std::filesystem::path& programs) {
  std::vector<std::string> argv = argv_of(task, directory);
  argv.insert(argv.begin(), (programs / kActorProgram).string());
  return {name, std::move(argv), directory.log(name)};
}

}  // namespace

std::vector<ProcessPlan> training_plan(const RunSettings& settings, const RunDirectory& directory,
                                       const std::filesystem::path& programs) {
  const auto server = [&](const char* name, const char* program) {
    return ProcessPlan{
        name, {(programs / program).string(), directory.root().string()}, directory.log(name)};
  };
  std::vector<ProcessPlan> plan = {server(kReplayName, "corridor-replay"),
                                   server(kLearnerName, "corridor-learner")};
  for (int i = 0; i < settings.actors; ++i) {
    plan.push_back(actor_process(actor_name(i), TrainTask{i}, directory, programs));
    // The replay server knows where it stood.
    plan.back().replaceable = true;
    plan.back().ends_by_itself = true;
  }
  return plan;
}

std::vector<EvaluationJob> evaluation_jobs(const std::vector<std::string>& planners,
                                           const std::vector<std::uint64_t>& seeds,
                                           std::int64_t steps) {
  std::vector<EvaluationJob> jobs;
  for (const std::string& planner : planners) {
    for (const std::uint64_t seed : seeds) jobs.push_back({planner, seed, steps});
  }
  return jobs;
}

ProcessPlan evaluation_process(const EvaluationJob& job, const RunDirectory& directory,
                               const RunDirectory& trained, const std::filesystem::path& programs,
                               const std::filesystem::path& fcd) {
  EvaluateTask task{job.planner, job.seed, job.steps};
  if (trained.root() != directory.root()) task.networks = trained.root();
  if (!fcd.empty()) task.fcd = fcd;
  return actor_process(fmt::format("evaluate-{}-{}", job.planner, job.seed), task, directory,
                       programs);
}

ProcessPlan hindsight_process(const EvaluationJob& job, const HindsightLimits& limits,
                              const RunDirectory& directory,
                              const std::filesystem::path& programs) {
  return actor_process(fmt::format("hindsight-{}-{}", job.planner, job.seed),
                       LookBackTask{job.planner, job.seed, limits}, directory, programs);
}

}  // namespace corridor::cluster
