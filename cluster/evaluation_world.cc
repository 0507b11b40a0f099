// SPDX-License-Identifier: Apache-2.0
#include "cluster/evaluation_world.h"

#include <algorithm>

#include "proto/base/failure.h"
#include "proto/config/config_values.h"
#include "proto/config/run_config.h"
#include "proto/run/checkpoints.h"
#include "proto/run/manifest.h"
#include "proto/settings/planner_pairs.h"
#include "proto/settings/schedule.h"
#include "proto/system/files.h"
#include "scenarios/sumo_files.h"

namespace corridor::cluster {
namespace {

// The settings of the world by that name. A setting that would be ignored there is refused.
RunConfig config_in(const RunConfig& trained, const EvaluationWorld& world,
                    const std::string& name) {
  const RunConfig scenario = world.scenario.empty()
                                 ? with_overrides(trained, name, world.settings)
                                 : load_run_config(world.scenario, world.settings);
  RunConfig config = in_world(trained, scenario, name);
  for (const ChangedKey& key : changed_keys(config, scenario)) {
    if (std::ranges::none_of(world.settings, [&](const std::string& setting) {
          return setting.starts_with(key.name + "=");
        })) {
      continue;
    }
    throw Failure(
        "{} belongs to the training, as which its planners drive everywhere: train a run with it "
        "(an evaluation may set {})",
        key.name, keys_where(set_by_world));
  }
  return config;
}

// Of earlier evaluations of the same networks with the same settings.
void check_results_of(const RunDirectory& directory, const RunDirectory& trained,
                      const RunConfig& config) {
  const auto refuse = [&](const char* what) {
    throw Failure("{} holds results of {}: choose another --out, or move it away",
                  directory.root().string(), what);
  };
  if (read_manifest(directory).run_id != read_manifest(trained).run_id) refuse("another run");
  if (!changed_keys(load_run_config(directory.config()), config).empty()) refuse("other settings");
}

RunDirectory results_directory(const std::filesystem::path& root, const RunDirectory& trained,
                               const RunConfig& config) {
  if (!std::filesystem::exists(root / kManifestFile)) {
    NewRun made(root);
    scenarios::write_sumo_files(config, made.directory().network().parent_path());
    write_file(made.directory().config(), to_toml(config));
    RunManifest manifest = read_manifest(trained);
    manifest.trained = std::filesystem::canonical(trained.root());
    write_manifest(made.directory(), manifest);
    made.publish();  // or another process has
  }
  RunDirectory directory = RunDirectory::open(root);
  check_results_of(directory, trained, config);
  return directory;
}

// Whose networks drive.
RunDirectory trained_run(const RunDirectory& given) {
  const auto trained = read_manifest(given).trained;
  return trained ? RunDirectory::open(*trained) : given;
}

}  // namespace

std::string EvaluationWorld::name(const std::string& own) const {
  std::string text = scenario.empty() ? own : scenario.stem().string();
  for (const std::string& setting : settings) {
    text += fmt::format("+{}", setting.substr(setting.find('.') + 1));
  }
  std::ranges::replace_if(
      text, [](char c) { return c == '/' || c == ',' || c == '"'; }, '_');
  return text;
}

EvaluationPlace evaluation_place(const std::filesystem::path& run, const EvaluationWorld& world,
                                 const std::filesystem::path& out) {
  const RunDirectory given = RunDirectory::open(run);
  const RunDirectory trained = trained_run(given);
  EvaluationPlace place{trained, given, load_run_config(given.config())};
  const std::filesystem::path root = out.empty() ? results_folder(given) : out;
  std::error_code missing;
  if (!std::filesystem::equivalent(root, given.root(), missing)) {
    place.directory = results_directory(root, trained, place.config);
  }
  if (!world.is_own()) {
    const RunConfig trained_as = load_run_config(trained.config());
    const std::string name =
        world.name(world.scenario.empty() ? read_manifest(trained).scenario_name() : "");
    place.config = config_in(trained_as, world, name);
    if (place.config.road.lanes != trained_as.road.lanes) {
      throw Failure("{} has {} lanes, and the networks of {} were trained on {}", name,
                    place.config.road.lanes, run.string(), trained_as.road.lanes);
    }
    place.directory =
        results_directory(RunDirectory::scenarios(root) / name, trained, place.config);
  }
  check_folder_for_results(place.directory.episodes());
  return place;
}

void check_can_drive(const std::string& planner, const EvaluationPlace& place) {
  const PlannerPair& pair = planner_pair(planner);
  const WorldKind world = place.config.dynamics.world;
  if (!pair.drives_in(world)) {
    throw Failure(
        "planner '{}' drives without dynamics of its own: choose others for dynamics.world = "
        "\"{}\"",
        planner, name_of(world));
  }
  if (!pair.learned()) return;
  if (std::filesystem::exists(place.trained.networks())) return;
  const std::uint64_t done = rounds_done(place.trained);
  if (done == 0) {
    throw Failure(
        "planner '{}' drives with learned weights, and {} has no checkpoint yet: wait, "
        "or choose --planners rules,sumo",
        planner, place.trained.root().string());
  }
  const std::uint64_t bp_begins = Schedule(place.config).first_round(Phase::kBp);
  if (pair.bp == BpKind::kLearned && done <= bp_begins) {
    throw Failure(
        "planner '{}' drives with the learned BP, and {} has trained the MoP only, for "
        "{} rounds: wait, or choose --planners rules,rules+mop,sumo",
        planner, place.trained.root().string(), done);
  }
}

std::filesystem::path find_episode(const RunDirectory& directory, const std::string& episode) {
  if (std::filesystem::is_regular_file(episode)) return episode;
  if (const auto name = parse_episode_name(episode)) {
    if (auto file = directory.episode(*name); std::filesystem::is_regular_file(file)) return file;
  }
  throw Failure("there is no episode '{}': give a file, or a name as in {}", episode,
                directory.episodes().string());
}

}  // namespace corridor::cluster
