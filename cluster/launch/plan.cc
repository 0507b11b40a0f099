#include "cluster/launch/plan.h"

#include "proto/base/format.h"

namespace corridor::cluster {

std::vector<ProcessPlan> training_plan(const RunSettings& settings, const RunDirectory& directory,
                                       const std::filesystem::path& programs) {
  const std::string run = directory.root().string();
  const auto process = [&](const std::string& name, const char* program,
                           std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {(programs / program).string(), run});
    return ProcessPlan{name, std::move(arguments), directory.log(name)};
  };
  std::vector<ProcessPlan> plan = {process(kReplayName, "corridor-replay", {}),
                                   process(kLearnerName, "corridor-learner", {})};
  for (int i = 0; i < settings.actors; ++i) {
    plan.push_back(process(actor_name(i), "corridor-actor", {"--index", std::to_string(i)}));
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
  const std::string name = fmt::format("evaluate-{}-{}", job.planner, job.seed);
  ProcessPlan plan{
      name,
      {(programs / "corridor-actor").string(), directory.root().string(), "--evaluate", job.planner,
       "--seed", std::to_string(job.seed), "--steps", std::to_string(job.steps)},
      directory.log(name)};
  if (trained.root() != directory.root()) {
    plan.argv.insert(plan.argv.end(), {"--networks", trained.root().string()});
  }
  if (!fcd.empty()) plan.argv.insert(plan.argv.end(), {"--fcd", fcd.string()});
  return plan;
}

std::filesystem::path evaluation_file(const EvaluationJob& job, const RunDirectory& directory) {
  return directory.evaluation() / fmt::format("{}_{}.json", job.planner, job.seed);
}

ProcessPlan hindsight_process(const EvaluationJob& job, const HindsightLimits& limits,
                              const RunDirectory& directory,
                              const std::filesystem::path& programs) {
  const std::string name = fmt::format("hindsight-{}-{}", job.planner, job.seed);
  return {name,
          {(programs / "corridor-actor").string(), directory.root().string(), "--look-back",
           job.planner, "--seed", std::to_string(job.seed), "--actions",
           std::to_string(limits.actions), "--attempts", std::to_string(limits.attempts)},
          directory.log(name)};
}

std::filesystem::path hindsight_file(const EvaluationJob& job, const RunDirectory& directory) {
  return directory.hindsight() / fmt::format("{}_{}.json", job.planner, job.seed);
}

}  // namespace corridor::cluster
