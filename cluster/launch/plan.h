// SPDX-License-Identifier: Apache-2.0
// Which processes a command starts: the run's configuration -> a list.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "proto/run/actor_task.h"
#include "proto/run/run_directory.h"
#include "proto/settings/settings.h"

namespace corridor::cluster {

struct ProcessPlan {
  std::string name;               // unique in a list; people see it
  std::vector<std::string> argv;  // argv[0] is the program's path
  std::filesystem::path log;      // standard output and error are appended to it
  bool replaceable = false;       // can be started again while the others go on
  bool ends_by_itself = false;    // before the main process has, when its own work is done
  bool operator==(const ProcessPlan&) const = default;
};

// The path of one of our programs: they all lie beside the running one.
std::string program_path(const char* name);

// Replay server, learner, and actors 0 .. actors-1. The learner ends by itself when all is done,
// and is to be stopped before the others, since its checkpoint needs them.
std::vector<ProcessPlan> training_plan(const RunSettings& settings, const RunDirectory& directory,
                                       bool allow_other_bits = false);

// An actor by itself; its log is the directory's of that name.
ProcessPlan actor_process(const std::string& name, const ActorTask& task,
                          const RunDirectory& directory);

// Every planner with every seed, planner by planner.
std::vector<EvaluateTask> evaluation_tasks(const std::vector<std::string>& planners,
                                           const std::vector<std::uint64_t>& seeds,
                                           std::int64_t steps);

}  // namespace corridor::cluster
