// SPDX-License-Identifier: Apache-2.0
#include "cluster/report/run_record.h"

#include <algorithm>

#include "cluster/launch/plan.h"
#include "proto/base/failure.h"
#include "proto/base/json.h"
#include "proto/config/config_values.h"
#include "proto/config/run_config.h"
#include "proto/run/fingerprint.h"
#include "proto/run/manifest.h"
#include "proto/run/run_directory.h"
#include "proto/system/files.h"

namespace corridor::cluster {
namespace {

std::vector<std::pair<std::string, std::string>> made_with(const RunManifest& manifest) {
  std::vector<std::pair<std::string, std::string>> result;
  const OrderedJson values = json_of<OrderedJson>(manifest).flatten();
  for (const auto& [path, value] : values.items()) {
    const std::string name = path.substr(path.rfind('/') + 1);
    // The settings are shown as a whole, and the id is what lets one into a run.
    if (name == "config" || name == "run_id") continue;
    result.emplace_back(name, value.is_string() ? value.get<std::string>() : value.dump());
  }
  return result;
}

// Or in what does not matter for the result.
bool differ_in_seed_only(const RunConfig& a, const RunConfig& b) {
  return std::ranges::none_of(changed_keys(a, b), [](const ChangedKey& key) {
    return key.name != "run.seed" && decides_result(key.heeds);
  });
}

ProcessMetrics read_metrics(const RunDirectory& directory, const std::string& process) {
  const std::filesystem::path file = directory.metrics(process);
  if (!std::filesystem::exists(file)) return {};
  return parse_metrics(read_file(file), file.string());
}

}  // namespace

std::filesystem::path RunRecord::driven_in(const std::string& world) const {
  return world.empty() ? root : RunDirectory::scenarios(root) / world;
}

RunRecord read_run(const std::filesystem::path& root) {
  const RunDirectory directory = RunDirectory::open(root);
  RunRecord run;
  run.root = root;
  run.config = load_run_config(directory.config());
  const RunManifest manifest = read_manifest(directory);
  run.scenario = manifest.scenario_name();
  run.made_with = made_with(manifest);

  for (int i = 0; i < run.config.run.actors; ++i) {
    run.actors.push_back(read_metrics(directory, actor_name(i)));
  }
  run.learner.push_back(read_metrics(directory, kLearnerName));
  const bool may_have_results_only = manifest.trained || manifest.fingerprint;
  if (!may_have_results_only && std::ranges::all_of(run.actors, &ProcessMetrics::empty)) {
    throw Failure("{} has no metrics of its actors yet: nothing was trained, or it has only begun",
                  root.string());
  }
  if (const auto checkpoint = Checkpoints(directory.checkpoints()).newest()) {
    run.rounds_done = checkpoint_round(*checkpoint) + 1;
    run.fingerprint = fingerprint(*checkpoint);
  }

  std::vector<std::string> worlds = {""};
  std::error_code missing;
  for (const auto& world :
       std::filesystem::directory_iterator(RunDirectory::scenarios(root), missing)) {
    worlds.push_back(world.path().filename());
  }
  for (const std::string& world : worlds) {
    const std::filesystem::path place = run.driven_in(world);
    auto results = read_evaluations(place / "evaluation");
    if (results.empty()) continue;
    run.evaluations[world] = std::move(results);
    run.worlds[world] = load_run_config(place / "config.toml");
    if (differ_in_seed_only(run.config, run.worlds[world])) run.worlds_of_training.insert(world);
  }
  return run;
}

std::vector<RunGroup> grouped_runs(std::vector<RunRecord> runs) {
  std::vector<RunGroup> groups;
  std::map<std::string, int> trainings;  // by the scenario's name
  for (RunRecord& run : runs) {
    const auto group = std::find_if(groups.begin(), groups.end(), [&](const RunGroup& other) {
      return differ_in_seed_only(other.runs.front().config, run.config);
    });
    if (group != groups.end()) {
      group->runs.push_back(std::move(run));
      continue;
    }
    const int number = ++trainings[run.scenario];
    const std::string label =
        number == 1 ? run.scenario : fmt::format("{} ({})", run.scenario, number);
    groups.push_back({label, {}});
    groups.back().runs.push_back(std::move(run));
  }
  for (RunGroup& group : groups) {
    const auto seed = [](const RunRecord& run) { return run.config.run.seed; };
    std::ranges::stable_sort(group.runs, {}, seed);
    const auto twice = std::ranges::adjacent_find(group.runs, {}, seed);
    if (twice == group.runs.end()) continue;
    throw Failure("{} and {} are the same training with the same seed, {}: name one of them",
                  twice->root.string(), std::next(twice)->root.string(), seed(*twice));
  }
  return groups;
}

}  // namespace corridor::cluster
