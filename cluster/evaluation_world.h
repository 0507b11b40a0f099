// SPDX-License-Identifier: Apache-2.0
// Where a run's planners are evaluated and shown: in their own world, or in another.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "proto/run/run_directory.h"
#include "proto/settings/settings.h"

namespace corridor::cluster {

// A scenario's world, with changes.
struct EvaluationWorld {
  std::filesystem::path scenario = {};     // empty: the run's own
  std::vector<std::string> settings = {};  // table.key=value, over the scenario

  bool is_own() const { return scenario.empty() && settings.empty(); }
  // "paper", "paper+world=slip+friction=0.5"; `own` is the name of the run's scenario.
  std::string name(const std::string& own) const;
};

// One run's planners in one world.
struct EvaluationPlace {
  RunDirectory trained;
  RunDirectory directory;  // for results: `trained` itself, or a run directory without networks
  RunConfig config;        // of `directory`
};

// `run`: a trained one, or a directory with results of one. Results go to `out`; where that is
// empty, to results_folder (proto/run/manifest.h): the run's own world's there, another one's into
// its scenarios/<name>. Makes what is not there yet; several processes may do so at a time. Another
// world's config.toml is in_world (proto/config) of the two. Throws Failure when the run's networks
// do not fit that world, for a setting that is not the world's, and when the directory holds
// anything else, or cannot be written to.
EvaluationPlace evaluation_place(const std::filesystem::path& run, const EvaluationWorld& world,
                                 const std::filesystem::path& out = {});

// Throws Failure when there is no such planner, when it cannot drive in that world, and when the
// run's newest checkpoint does not have what it drives with.
void check_can_drive(const std::string& planner, const EvaluationPlace& place);

// A file's path, or a name as in evaluation/episodes ("rules_1001_3"). Throws Failure when it is
// neither.
std::filesystem::path find_episode(const RunDirectory& directory, const std::string& episode);

}  // namespace corridor::cluster
