// SPDX-License-Identifier: Apache-2.0
#include "cluster/experiment_file.h"

#include <algorithm>
#include <optional>
#include <set>
#include <sstream>

#include "cluster/launch/plan.h"
#include "proto/base/failure.h"
#include "proto/base/json.h"
#include "proto/base/text.h"
#include "proto/config/run_config.h"
#include "proto/settings/planner_pairs.h"

namespace corridor::cluster {
namespace {

// One table of the file; every key that is asked for is known.
class TableReader {
 public:
  TableReader(const Json& table, std::string place) : table_(table), place_(std::move(place)) {}

  template <typename T>
  T required(const char* key) {
    std::optional<T> value = optional<T>(key);
    if (!value) throw Failure("{}: {} is missing", place_, key);
    return *std::move(value);
  }
  template <typename T>
  std::optional<T> optional(const char* key) {
    know(key);
    if (!table_.contains(key)) return std::nullopt;
    try {
      T value;
      read(table_.at(key), value);
      return value;
    } catch (const std::exception& error) {
      throw Failure("{}: {} = {}: {}", place_, key, table_.at(key).dump(), error.what());
    }
  }
  void know(const char* key) { known_.insert(key); }
  void refuse_unknown() const {
    for (const auto& [key, value] : table_.items()) {
      if (known_.contains(key)) continue;
      throw Failure("{}: unknown key {}: known are {}", place_, key, listed(known_));
    }
  }
  const std::string& place() const { return place_; }

 private:
  static void read(const Json& value, std::string& into) {
    if (!value.is_string() || value.get<std::string>().empty()) {
      throw Failure("must be a text in quotes");
    }
    into = value.get<std::string>();
  }
  static void read(const Json& value, std::int64_t& into) {
    into = whole_number<std::int64_t>(value);
    if (into < 1) throw Failure("must be at least 1");
  }
  static void read(const Json& value, std::uint64_t& into) {
    into = whole_number<std::uint64_t>(value);
  }
  template <typename T>
  static void read(const Json& list, std::vector<T>& into) {
    if (!list.is_array() || list.empty()) throw Failure("must be a list with something in it");
    for (const Json& value : list) {
      T element;
      read(value, element);
      if (std::ranges::find(into, element) != into.end()) throw Failure("names one thing twice");
      into.push_back(element);
    }
  }

  const Json& table_;
  std::string place_;
  std::set<std::string> known_;
};

// What `check` throws, with the place in the file.
template <typename Check>
void check_at(const std::string& place, const Check& check) {
  try {
    check();
  } catch (const Failure& failure) {
    throw Failure("{}: {}", place, failure.what());
  }
}

void check_planners(const std::vector<std::string>& planners) {
  for (const std::string& planner : planners) planner_pair(planner);
}

// A scenario's file, whose name may have spaces in it, and settings behind it, separated by spaces.
EvaluationWorld parse_world(const std::string& text, const std::filesystem::path& folder) {
  std::vector<std::string> settings;
  std::string file = text.substr(0, text.find_last_not_of(' ') + 1);
  for (std::size_t space = file.rfind(' ');
       space != std::string::npos && file.find('=', space) != std::string::npos;
       space = file.rfind(' ')) {
    settings.insert(settings.begin(), file.substr(space + 1));
    file.erase(file.find_last_not_of(' ', space) + 1);
  }
  return {folder / file, settings};
}

TrainingArm parse_training(TableReader& table, const std::filesystem::path& folder,
                           const std::vector<std::string>& planners,
                           const std::vector<std::uint64_t>& training_seeds) {
  constexpr const char* kNameCharacters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_";
  TrainingArm training;
  training.name = table.required<std::string>("name");
  if (training.name.find_first_not_of(kNameCharacters) != std::string::npos) {
    throw Failure("{}: name = \"{}\": must be letters, digits and _", table.place(), training.name);
  }
  training.scenario = folder / table.required<std::string>("scenario");
  training.settings =
      table.optional<std::vector<std::string>>("settings").value_or(std::vector<std::string>{});
  training.from = table.optional<std::string>("from").value_or("");
  for (const auto& world : table.required<std::vector<std::string>>("evaluate_in")) {
    training.evaluate_in.push_back(parse_world(world, folder));
  }
  training.planners = table.optional<std::vector<std::string>>("planners").value_or(planners);
  training.training_seeds =
      table.optional<std::vector<std::uint64_t>>("training_seeds").value_or(training_seeds);
  table.refuse_unknown();

  check_at(table.place(), [&] {
    check_planners(training.planners);
    load_run_config(training.scenario, training.settings);
    for (const auto& world : training.evaluate_in) load_run_config(world.scenario, world.settings);
  });
  std::set<std::string> names;
  for (const auto& world : training.evaluate_in) {
    if (names.insert(world.name("")).second) continue;
    throw Failure("{}: evaluate_in has two worlds of the name {}", table.place(), world.name(""));
  }
  return training;
}

// `trainings` ends with `arm`.
void check_from(const TrainingArm& arm, const std::vector<TrainingArm>& trainings,
                const std::string& place) {
  if (arm.from.empty()) return;
  const auto from = std::ranges::find(trainings, arm.from, &TrainingArm::name);
  if (from == trainings.end() || &*from == &trainings.back() || !from->from.empty()) {
    throw Failure("{}: from = \"{}\": must be a training above that begins with random networks",
                  place, arm.from);
  }
  for (const std::uint64_t seed : arm.training_seeds) {
    if (std::ranges::find(from->training_seeds, seed) != from->training_seeds.end()) continue;
    throw Failure("{}: from = \"{}\": that one has no training seed {}", place, arm.from, seed);
  }
}

}  // namespace

Experiment load_experiment(const std::filesystem::path& file) {
  const Json document = load_toml(file);
  TableReader table(document, file.string());
  Experiment experiment;
  const auto planners = table.required<std::vector<std::string>>("planners");
  const auto training_seeds = table.required<std::vector<std::uint64_t>>("training_seeds");
  experiment.evaluation_seeds = table.required<std::vector<std::uint64_t>>("evaluation_seeds");
  experiment.evaluation_steps = table.required<std::int64_t>("evaluation_steps");
  check_at(table.place(), [&] { check_planners(planners); });

  const Json trainings = document.value("training", Json());
  if (!trainings.is_array() || trainings.empty()) {
    throw Failure("{}: [[training]] is missing: write one for each network to train",
                  file.string());
  }
  std::set<std::string> names;
  for (const Json& entry : trainings) {
    TableReader training(entry,
                         fmt::format("{}: [[training]] {}", file.string(), names.size() + 1));
    if (!entry.is_object()) throw Failure("{} is no table", training.place());
    experiment.trainings.push_back(
        parse_training(training, file.parent_path(), planners, training_seeds));
    const TrainingArm& arm = experiment.trainings.back();
    check_from(arm, experiment.trainings, training.place());
    if (names.insert(arm.name).second) continue;
    throw Failure("{}: there is another one of the name {}", training.place(), arm.name);
  }
  table.know("training");
  table.refuse_unknown();
  return experiment;
}

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

std::vector<EvaluateTask> tasks_of(const TrainingRun& run, const Experiment& experiment,
                                   WorldKind world) {
  const bool first = run.seed == run.training->training_seeds.front();
  std::vector<std::string> planners;
  for (const std::string& planner : run.training->planners) {
    const PlannerPair& pair = planner_pair(planner);
    if ((pair.learned() || first) && pair.drives_in(world)) planners.push_back(planner);
  }
  std::vector<EvaluateTask> tasks =
      evaluation_tasks(planners, experiment.evaluation_seeds, experiment.evaluation_steps);
  for (EvaluateTask& task : tasks) task.networks = run.root;
  return tasks;
}

}  // namespace corridor::cluster
