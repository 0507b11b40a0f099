// SPDX-License-Identifier: Apache-2.0
// whole_run SCENARIO: trains as a user would, and says where the cores' time went: wall time times
// cores, by phase and part, from the metrics that every run writes (proto/system/time_account.h).
#include <cstdio>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "cluster/launch/local.h"
#include "cluster/launch/plan.h"
#include "cluster/watch/training_progress.h"
#include "proto/base/failure.h"
#include "proto/config/run_config.h"
#include "proto/run/metrics.h"
#include "proto/run/run_directory.h"
#include "proto/system/command_line.h"
#include "proto/system/program.h"
#include "proto/system/time_account.h"
#include "tests/bench/td_floor.h"
#include "tests/support/command.h"
#include "tests/support/temporary_directory.h"

namespace corridor::bench {
namespace {

using cluster::CoreTime;
using corridor::MetricsLine;
using corridor::value_of;

constexpr double kDeadline_s = 3600.0;
const std::string kBin = CORRIDOR_BIN_DIR;

std::vector<MetricsLine> lines_of(const std::filesystem::path& file) {
  std::vector<MetricsLine> lines;
  std::ifstream in(file);
  for (std::string text; std::getline(in, text);) {
    if (auto line = parse_metrics_line(text)) lines.push_back(std::move(*line));
  }
  return lines;
}

struct PhaseTime {
  double wall_s = 0.0;
  double steps = 0.0;
  double updates = 0.0;
  CoreTime core_s;  // by "process part"
};

// Core-seconds of all processes of a run, by phase.
std::map<std::string, PhaseTime> phases_of(const RunDirectory& run, int actors) {
  std::map<std::string, PhaseTime> phases;
  const auto add = [&](const std::string& file, const std::string& process) {
    for (const MetricsLine& line : lines_of(run.metrics(file))) {
      PhaseTime& phase = phases[line.phase];
      const double wall_s = value_of(line.values, kWallTimeMetric);
      for (const auto& [part, cores] : cluster::cores_by_part(line.values)) {
        phase.core_s[process + " " + part] += cores * wall_s;
      }
      if (process != kLearnerName) continue;
      phase.wall_s += wall_s;
      phase.steps = static_cast<double>(line.step);
      phase.updates = value_of(line.values, metric::kUpdates);
    }
  };
  for (int i = 0; i < actors; ++i) add(actor_name(i), "actor");
  add(kLearnerName, kLearnerName);
  add(kReplayName, kReplayName);
  return phases;
}

// SUMO's own work and the networks'.
bool is_floor(const std::string& part) {
  return part == "actor simulate" || part == "actor traffic" || part == "actor infer" ||
         part == "learner update";
}

// Parts are shares of the processes' wall time: one in which the scheduler takes the core away
// looks larger than it is, the learner's transport above all, which wakes the server.
void print(const std::map<std::string, PhaseTime>& phases, const RunConfig& config, int cores) {
  for (const Phase which : {Phase::kMop, Phase::kBp}) {
    const std::string name = phase_name(which);
    const PhaseTime& phase = phases.at(name);
    const double all_s = phase.wall_s * cores;
    std::printf("\n%s: %.0f steps in %.1f s, %.0f steps/s; %d cores x wall time = %.1f core-s\n",
                name.c_str(), phase.steps, phase.wall_s, phase.steps / phase.wall_s, cores, all_s);
    const auto row = [&](const std::string& what, double core_s) {
      std::printf("  %-28s %8.2f core-s  %5.1f %%\n", what.c_str(), core_s, 100.0 * core_s / all_s);
    };
    double floor_s = 0.0, busy_s = 0.0;
    for (const bool in_floor : {true, false}) {
      for (const auto& [part, core_s] : phase.core_s) {
        if (is_floor(part) != in_floor) continue;
        row(part, core_s);
        busy_s += core_s;
        if (in_floor) floor_s += core_s;
      }
      if (in_floor) row("= SUMO and networks", floor_s);
    }
    row("idle", all_s - busy_s);
    const auto of_actor = [&](const char* part) {
      const auto found = phase.core_s.find(std::string("actor ") + part);
      return found == phase.core_s.end() ? 0.0 : found->second;
    };
    const double sumo_s = of_actor("simulate") + of_actor("traffic");
    const double agent_s = of_actor("world") + of_actor("plan") + of_actor("infer");
    std::printf("  SUMO and networks of the busy time: %.1f %%\n", 100.0 * floor_s / busy_s);
    const double step_us = 1e6 * phase.core_s.at("learner update") / phase.updates;
    const DqnSettings& dqn = config.phase(which);
    const double bare_us = dqn.networks() * TdFloor::step_us(config.network(which), dqn.batch_size);
    std::printf(
        "  a training step: %.1f us, %.2f of its bare arithmetic alone on a core (%.1f us)\n",
        step_us, step_us / bare_us, bare_us);
    std::printf("  environment with agent: %.2f of SUMO's own step rate, %.2f with loading\n",
                sumo_s / (sumo_s + agent_s), sumo_s / (sumo_s + agent_s + of_actor("load")));
  }
}

void print_memory(const RunDirectory& run) {
  std::printf("\npeak resident memory:");
  for (const std::string& process :
       {actor_name(0), std::string(kLearnerName), std::string(kReplayName)}) {
    const auto line = last_metrics_line(run.metrics(process));
    if (line) std::printf("  %s %.0f MB", process.c_str(), value_of(line->values, "memory_mb"));
  }
  std::printf("\n");
}

int run(const std::string& scenario, int actors, const std::string& seed,
        const std::vector<std::string>& settings) {
  testing_support::TemporaryDirectory temporary;
  const std::filesystem::path root = temporary.path() / "run";
  std::vector<std::string> command = {
      kBin + "/corridor",     "train",  scenario, "--run", root, "--actors",
      std::to_string(actors), "--seed", seed};
  for (const std::string& setting : settings) {
    command.insert(command.end(), {"--set", setting});
  }
  const auto trained = testing_support::run_command(command, kDeadline_s);
  if (trained.status != 0) throw Failure("corridor train failed: {}", trained.output);
  std::printf("%s with %d actors: %.1f s from command to prompt\n", scenario.c_str(), actors,
              trained.seconds);
  const RunDirectory directory = RunDirectory::open(root);
  print(phases_of(directory, actors), load_run_config(directory.config()), available_cores());
  print_memory(directory);

  // An actor that drives a single step, from exec to its end.
  const std::vector<std::string> one_step =
      cluster::actor_process("one-step", EvaluateTask{.planner = "rules", .seed = 1, .steps = 1},
                             directory)
          .argv;
  for (int i = 0; i < 3; ++i) {
    const auto driven = testing_support::run_command(one_step, kDeadline_s);
    if (driven.status != 0) throw Failure("corridor-actor failed: {}", driven.output);
    std::printf("an actor starts, loads, drives one step and ends in %.2f s\n", driven.seconds);
  }
  return 0;
}

}  // namespace
}  // namespace corridor::bench

int main(int argc, char** argv) {
  CLI::App app("Trains a scenario and says where the cores' time went.");
  std::string scenario, seed = "1";
  int actors = 2;
  std::vector<std::string> settings;
  app.add_option("SCENARIO", scenario, "a scenario file")->required();
  app.add_option("--actors", actors, "actor processes");
  app.add_option("--seed", seed, "of the run");
  app.add_option("--set", settings, "key=value, as of corridor train");
  CLI11_PARSE(app, argc, argv);
  return corridor::run_program(
      "whole_run", [&] { return corridor::bench::run(scenario, actors, seed, settings); });
}
