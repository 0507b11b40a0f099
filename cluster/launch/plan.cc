// SPDX-License-Identifier: Apache-2.0
#include "cluster/launch/plan.h"

#include "proto/run/manifest.h"

namespace corridor::cluster {

std::string program_path(const char* name) {
  return std::filesystem::read_symlink("/proc/self/exe").replace_filename(name);
}

std::vector<ProcessPlan> training_plan(const RunSettings& settings, const RunDirectory& directory,
                                       bool allow_other_bits) {
  const auto server = [&](const char* name, const char* program) {
    return ProcessPlan{
        name, {program_path(program), directory.root().string()}, directory.log(name)};
  };
  std::vector<ProcessPlan> plan = {server(kReplayName, kReplayProgram),
                                   server(kLearnerName, kLearnerProgram)};
  if (allow_other_bits) plan.back().argv.emplace_back(kAllowOtherBits);
  for (int i = 0; i < settings.actors; ++i) {
    plan.push_back(actor_process(actor_name(i), TrainTask{i}, directory));
    // The replay server knows where it stood.
    plan.back().replaceable = true;
    plan.back().ends_by_itself = true;
  }
  return plan;
}

ProcessPlan actor_process(const std::string& name, const ActorTask& task,
                          const RunDirectory& directory) {
  std::vector<std::string> argv = argv_of(task, directory);
  argv.insert(argv.begin(), program_path(kActorProgram));
  return {name, std::move(argv), directory.log(name)};
}

std::vector<EvaluateTask> evaluation_tasks(const std::vector<std::string>& planners,
                                           const std::vector<std::uint64_t>& seeds,
                                           std::int64_t steps) {
  std::vector<EvaluateTask> tasks;
  for (const std::string& planner : planners) {
    for (const std::uint64_t seed : seeds) tasks.push_back({planner, seed, steps});
  }
  return tasks;
}

}  // namespace corridor::cluster
