#include "cluster/evaluate.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "cluster/launch/local.h"
#include "cluster/launch/manifest.h"
#include "cluster/launch/plan.h"
#include "cluster/results/evaluation_result.h"
#include "cluster/results/results_tables.h"
#include "cluster/watch/display.h"
#include "cluster/watch/line_tail.h"
#include "cluster/watch/step_progress.h"
#include "proto/base/failure.h"
#include "proto/base/json.h"
#include "proto/base/text.h"
#include "proto/config/run_config.h"
#include "proto/run/fingerprint.h"
#include "proto/settings/planner_pairs.h"
#include "proto/settings/schedule.h"
#include "proto/system/files.h"
#include "scenarios/sumo_files.h"

namespace corridor::cluster {
namespace {

template <typename T>
void refuse_repeated(std::vector<T> values, const char* what) {
  std::sort(values.begin(), values.end());
  const auto repeated = std::adjacent_find(values.begin(), values.end());
  if (repeated != values.end()) throw Failure("{} {} is given twice", what, *repeated);
}

// Now rather than after the driving.
void check_can_write(const std::filesystem::path& file) {
  const std::filesystem::path parent = std::filesystem::absolute(file).parent_path();
  if (access(parent.c_str(), W_OK) != 0 || std::filesystem::is_directory(file)) {
    throw Failure("cannot write {}: {}", file.string(),
                  std::filesystem::is_directory(file) ? "it is a directory" : std::strerror(errno));
  }
}

}  // namespace

std::vector<EvaluationJob> chosen_jobs(std::vector<std::string> planners,
                                       std::vector<std::uint64_t> seeds, std::int64_t steps,
                                       const RunConfig& config) {
  if (planners.empty()) {
    for (const PlannerPair& pair : kPlannerPairs) {
      if (pair.by_default) planners.emplace_back(pair.name);
    }
  }
  if (seeds.empty()) seeds = config.evaluation.seeds;
  for (const std::string& planner : planners) planner_pair(planner);
  refuse_repeated(planners, "planner");
  refuse_repeated(seeds, "evaluation seed");
  return evaluation_jobs(planners, seeds, steps);
}

int parallel_jobs(std::optional<int> jobs) {
  const int parallel = jobs.value_or(available_cores());
  if (parallel < 1) throw Failure("--jobs {}: at least 1 is needed", parallel);
  return parallel;
}

void check_can_drive(const std::string& planner, const RunDirectory& directory,
                     const RunConfig& config) {
  const PlannerPair& pair = planner_pair(planner);
  const bool learned_bp = pair.bp == BpKind::kLearned;
  if (pair.world_drives() && config.dynamics.world != "kinematic") {
    throw Failure(
        "planner '{}' drives without dynamics of its own: choose others for dynamics.world = "
        "\"{}\"",
        planner, config.dynamics.world);
  }
  if (!pair.learned()) return;
  if (std::filesystem::exists(directory.networks())) return;
  const std::optional<Checkpoint> checkpoint = newest_checkpoint(directory);
  if (!checkpoint) {
    throw Failure(
        "planner '{}' drives with learned weights, and {} has no checkpoint yet: wait, "
        "or choose --planners rules,sumo",
        planner, directory.root().string());
  }
  const std::uint64_t bp_begins = Schedule(config).first_round(Phase::kBp);
  if (learned_bp && checkpoint->rounds_done <= bp_begins) {
    throw Failure(
        "planner '{}' drives with the learned BP, and {} has trained the MoP only, for "
        "{} rounds: wait, or choose --planners rules,rules+mop,sumo",
        planner, directory.root().string(), checkpoint->rounds_done);
  }
}

std::string EvaluationWorld::name(const std::string& own) const {
  std::string text = scenario.empty() ? own : scenario.stem().string();
  for (const std::string& setting : settings) {
    text += fmt::format("+{}", setting.substr(setting.find('.') + 1));
  }
  std::ranges::replace_if(
      text, [](char c) { return c == '/' || c == ',' || c == '"'; }, '_');
  return text;
}

RunDirectory world_directory(const RunDirectory& run, const EvaluationWorld& world) {
  const RunConfig trained = load_run_config(run.config());
  const RunConfig scenario =
      load_run_config(world.scenario.empty() ? run.config() : world.scenario, world.settings);
  RunConfig config = trained;
  config.road = scenario.road;
  config.traffic = scenario.traffic;
  config.simulation = scenario.simulation;
  config.ego = scenario.ego;
  config.dynamics = scenario.dynamics;
  config.planner.corridor_change_s = scenario.planner.corridor_change_s;
  config.bp_reward = scenario.bp_reward;
  config.evaluation = scenario.evaluation;
  const std::string name = world.name(world.scenario.empty() ? scenario_name(run) : "");
  // What a setting would change now is the trained planners' own.
  const std::vector<ChangedKey> ignored =
      changed_keys(config, parse_run_config(to_toml(config), name, world.settings));
  if (!ignored.empty()) {
    throw Failure(
        "{} belongs to the training, as which its planners drive everywhere: train a run with it "
        "(an evaluation may set [road], [traffic], [simulation], [ego], [dynamics], [bp_reward], "
        "[evaluation] and planner.corridor_change_s)",
        ignored.front().name);
  }
  if (config.road.lanes != trained.road.lanes) {
    throw Failure("{} has {} lanes, and the networks of {} were trained on {}", name,
                  config.road.lanes, run.root().string(), trained.road.lanes);
  }
  const std::filesystem::path root = RunDirectory::scenarios(run.root()) / name;
  const std::string text = to_toml(config);
  if (std::filesystem::exists(root / "config.toml")) {
    RunDirectory directory = RunDirectory::open(root);
    if (to_toml(load_run_config(directory.config())) == text) return directory;
    throw Failure("{} holds what was driven with other settings than {}'s: move it away",
                  root.string(), name);
  }
  // config.toml is written last: without it, somebody was stopped here.
  on_disk("remove", root, [&] { std::filesystem::remove_all(root); });
  on_disk("create", root, [&] { std::filesystem::create_directories(root.parent_path()); });
  RunDirectory directory = RunDirectory::create(root);
  scenarios::write_sumo_files(config, directory.network().parent_path());
  write_file(directory.manifest(), read_file(run.manifest()));
  write_file(directory.config(), text);
  return directory;
}

RunDirectory directory_to_drive_in(const RunDirectory& run, const EvaluationWorld& world) {
  const bool own = world.scenario.empty() && world.settings.empty();
  return own ? run : world_directory(run, world);
}

void complete_sumo_files(const RunDirectory& directory, const RunConfig& config) {
  if (std::filesystem::exists(directory.network())) return;
  scenarios::write_sumo_files(config, directory.network().parent_path());
}

int evaluate(const EvaluateOptions& options) {
  const RunDirectory trained = RunDirectory::open(options.run);
  const RunDirectory directory = directory_to_drive_in(trained, options.world);
  const RunConfig config = load_run_config(directory.config());
  const std::int64_t steps = options.steps.value_or(config.evaluation.steps);
  if (steps < 1) throw Failure("--steps {}: at least 1 is needed", steps);
  const std::vector<EvaluationJob> jobs =
      chosen_jobs(options.planners, options.seeds, steps, config);
  for (const EvaluationJob& job : jobs) check_can_drive(job.planner, trained, config);
  const int parallel = parallel_jobs(options.jobs);
  if (!options.json.empty()) check_can_write(options.json);
  complete_sumo_files(directory, config);

  std::vector<ProcessPlan> plan;
  std::vector<StepTask> tasks;
  for (const EvaluationJob& job : jobs) {
    plan.push_back(evaluation_process(job, directory, trained, program_directory(), options.fcd));
    tasks.push_back({fmt::format("{} {}", job.planner, job.seed), job.steps, 0, plan.back().log,
                     parse_step_count});
  }
  StepProgress progress("evaluation", std::move(tasks), monotonic_s());
  const Ending ending = run_queue(plan, parallel, Limits{}, [&] { progress.tick(monotonic_s()); });
  if (ending.signal != 0) {
    fmt::print("stopped: no table\n");
    return 128 + ending.signal;
  }

  std::vector<EvaluationResult> results;
  std::vector<SeedResult> of_this_run;
  for (const EvaluationJob& job : jobs) {
    results.push_back(read_evaluation(evaluation_file(job, directory)));
    of_this_run.push_back({config.run.seed, results.back()});
  }
  fmt::print("\n{}: {} steps for each planner and seed\n", directory.root().string(),
             grouped(jobs.front().steps));
  for (const Table& table : results_tables(arms_of(of_this_run))) {
    fmt::print("\n{}", text_of(table));
  }
  fmt::print("\n{}", text_of(paper_table()));
  if (!options.json.empty()) {
    write_file(options.json, evaluation_json(results).dump(2) + "\n");
  }
  fmt::print("\nepisodes in {}; drive one again with corridor redrive\n",
             directory.episodes().string());
  return 0;
}

std::filesystem::path find_episode(const RunDirectory& directory, const std::string& episode) {
  if (std::filesystem::is_regular_file(episode)) return episode;
  const std::filesystem::path file = directory.episodes() / (episode + ".json");
  if (std::filesystem::is_regular_file(file)) return file;
  throw Failure("there is no episode '{}': give a file, or a name as in {}", episode,
                directory.episodes().string());
}

void redrive(const std::filesystem::path& run, const std::string& episode) {
  const RunDirectory directory = RunDirectory::open(run);
  std::string program = program_directory() / "corridor-actor";
  std::string root = directory.root(), file = find_episode(directory, episode);
  std::string flag = "--redrive";
  char* const argv[] = {program.data(), root.data(), flag.data(), file.data(), nullptr};
  execv(program.c_str(), argv);
  throw Failure("cannot start {}: {}; is the build complete?", program, std::strerror(errno));
}

}  // namespace corridor::cluster
