// SPDX-License-Identifier: Apache-2.0
#include "cluster/commands.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <vector>

#include "cluster/check.h"
#include "cluster/completion.h"
#include "cluster/drive.h"
#include "cluster/evaluate.h"
#include "cluster/experiment.h"
#include "cluster/export.h"
#include "cluster/hindsight.h"
#include "cluster/report/report.h"
#include "cluster/train.h"
#include "proto/base/failure.h"
#include "proto/run/fingerprint.h"
#include "proto/settings/limits.h"
#include "proto/settings/planner_pairs.h"
#include "proto/system/command_line.h"
#include "proto/system/program.h"

namespace corridor::cluster {
namespace {

// Of things that a command goes through one by one.
constexpr std::uint64_t kCountMax = 1'000'000;
constexpr const char* kProcesses = "processes at a time (the number of cores)";  // of --jobs

// What the command line says; each command reads its part.
struct Arguments {
  std::string program;
  TrainOptions train;
  ResumeOptions resume;
  EvaluateOptions evaluate;
  HindsightOptions hindsight;
  ExperimentOptions experiment;
  ReportOptions report;
  DriveOptions drive;
  std::filesystem::path run;
  std::filesystem::path scenario;
  std::vector<std::string> settings;
  std::string world;
  std::string episode;
  std::filesystem::path exported;
  const CLI::App* command_line = nullptr;
  std::string format;
};

void declare_settings(CLI::App& app, std::vector<std::string>& settings) {
  app.add_option("--set", settings, "table.key=value: overrides the scenario; repeatable")
      ->allow_extra_args(false);
}

// Several, separated by commas.
template <typename Value>
CLI::Option* declare_list(CLI::App& app, const char* name, std::vector<Value>& values,
                          const std::string& meaning) {
  return app.add_option(name, values, meaning)->delimiter(',')->allow_extra_args(false);
}

void declare_seeds(CLI::App& app, std::vector<std::uint64_t>& seeds) {
  declare_list(app, "--seeds", seeds, "evaluation seeds (evaluation.seeds)")
      ->check(whole_number(0, kSeedMax));
}

void declare_jobs(CLI::App& app, std::optional<int>& jobs, const char* meaning) {
  app.add_option("--jobs", jobs, meaning)->check(whole_number(1, kCountMax));
}

void declare_train(CLI::App& app, Arguments& arguments) {
  TrainOptions& options = arguments.train;
  app.add_option("SCENARIO", options.scenario, "scenario file (TOML)")->required();
  app.add_option("--run", options.run, "run directory to create")->required();
  app.add_option("--from", options.from, "begin with the networks of this run, not random ones");
  app.add_option("--actors", options.actors, "actor processes (run.actors)")->take_last();
  app.add_option("--seed", options.seed, "seed of everything random (run.seed)")
      ->take_last()
      ->check(whole_number(0, kSeedMax));
  declare_settings(app, options.settings);
}

void declare_run(CLI::App& app, std::filesystem::path& run) {
  app.add_option("DIR", run, "run directory")->required();
}

// The world to drive in.
void declare_world(CLI::App& app, Arguments& arguments, EvaluationWorld& into) {
  app.add_option("--scenario", into.scenario,
                 "drive in this scenario's world (TOML); the run's own unless given");
  std::string worlds = "what the ego drives with (dynamics.world):";
  for (const auto& world : kChoices<WorldKind>) {
    worlds += fmt::format("\n{} ({})", world.name, world.meaning);
  }
  app.add_option("--world", arguments.world, worlds);
  declare_settings(app, into.settings);
  app.callback([&arguments, &into] {
    if (arguments.world.empty()) return;
    into.settings.insert(into.settings.begin(), "dynamics.world=" + arguments.world);
  });
}

void declare_drive(CLI::App& app, Arguments& arguments) {
  DriveOptions& options = arguments.drive;
  declare_run(app, options.run);
  declare_world(app, arguments, options.world);
  app.add_option("--planner", options.planner, "who drives, as in evaluate")->capture_default_str();
  app.add_option("--seed", options.seed, "of the traffic (the first of evaluation.seeds)")
      ->check(whole_number(0, kSeedMax));
  app.add_option("--number", options.number, "which episode of that seed")
      ->capture_default_str()
      ->check(whole_number(0, kCountMax));
  app.add_option("--episode", options.episode, "a recorded one: a file, or a name as in redrive");
  app.add_flag("--collisions", options.collisions, "the planner's collisions in its evaluations");
  app.add_option("--most", options.most, "of them, at most")
      ->capture_default_str()
      ->check(whole_number(1, kCountMax));
  app.add_option("--from", options.from_s, "seconds after the episode's start")
      ->capture_default_str();
  app.add_option("--seconds", options.seconds, "to show")->capture_default_str();
  app.add_option("--interval", options.interval_s, "seconds between the contact sheet's pictures")
      ->capture_default_str();
  app.add_option("--out", options.out, "folder to write to (drives/ beside the evaluation)");
  app.add_flag("!--no-film", options.film, "contact sheet and player only: needs no ffmpeg");
}

void declare_out(CLI::App& app, std::filesystem::path& out) {
  app.add_option("--out", out,
                 "folder for results (the run itself; for an exported one, evaluated/ here)");
}

void declare_evaluate(CLI::App& app, Arguments& arguments) {
  EvaluateOptions& options = arguments.evaluate;
  declare_run(app, options.run);
  declare_world(app, arguments, options.world);
  std::string planners = "planner pairs, separated by commas; those marked * unless given:";
  for (const PlannerPair& pair : kPlannerPairs) {
    planners += fmt::format("\n{}{} ({})", pair.name, pair.by_default ? "*" : "", pair.meaning);
  }
  declare_list(app, "--planners", options.planners, planners);
  app.add_option("--steps", options.steps, "steps for each planner and seed (evaluation.steps)")
      ->check(whole_number(1, kStepsMax));
  declare_seeds(app, options.seeds);
  declare_jobs(app, options.jobs, kProcesses);
  declare_out(app, options.out);
  app.add_option("--json", options.json,
                 "write the figures of each planner and seed to this file; -: to standard output");
  app.add_option("--fcd", options.fcd,
                 "have SUMO write the trajectories of every episode into this directory");
}

void declare_hindsight(CLI::App& app, Arguments& arguments) {
  HindsightOptions& options = arguments.hindsight;
  app.add_option("DIR", options.run, "run directory, or one of its scenarios/<name>")->required();
  declare_list(app, "--planners", options.planners,
               "planner pairs, separated by commas; those of `corridor evaluate` unless given");
  declare_seeds(app, options.seeds);
  app.add_option("--actions", options.limits.actions, "search the last so many actions")
      ->capture_default_str()
      ->check(whole_number(1, HindsightLimits::kActionsMax));
  app.add_option("--attempts", options.limits.attempts_max,
                 "give up a search after so many attempts")
      ->capture_default_str()
      ->check(whole_number(1, kCountMax));
  declare_jobs(app, options.jobs, kProcesses);
  declare_out(app, options.out);
}

int run_fingerprint(const Arguments& arguments) {
  const auto checkpoint = Checkpoints(RunDirectory::open(arguments.run).checkpoints()).newest();
  if (!checkpoint) throw Failure("{} has no checkpoint yet", arguments.run.string());
  fmt::print("{}\n", fingerprint(*checkpoint));
  return 0;
}

struct Command {
  const char* name;
  const char* summary;
  const char* examples;
  void (*declare)(CLI::App&, Arguments&);
  int (*run)(const Arguments&);
};

const Command kCommands[] = {
    {"train", "Train the MoP, then the BP, with several actors",
     "corridor train scenarios/smoke.toml --run runs/first\n"
     "  corridor train scenarios/paper.toml --run runs/paper --actors 4 --seed 2\n"
     "  corridor train scenarios/paper.toml --run runs/calm --set traffic.blind_rate_per_s=0",
     declare_train, [](const Arguments& a) { return train(a.train, a.program); }},
    {"resume", "Go on with a training from its newest checkpoint",
     "corridor resume runs/first\n"
     "  corridor resume runs/first --set schedule.checkpoint_every_steps=20000\n"
     "  corridor resume runs/first --set bp.steps=800000",
     [](CLI::App& app, Arguments& a) {
       declare_run(app, a.resume.run);
       declare_settings(app, a.resume.settings);
       app.add_flag(kAllowOtherBits, a.resume.allow_other_bits,
                    "go on with other libraries than so far; the manifest says so");
     },
     [](const Arguments& a) { return resume(a.resume, a.program); }},
    {"evaluate", "Drive planners greedily on held-out traffic and print the paper's table",
     "corridor evaluate runs/first\n"
     "  corridor evaluate runs/first --scenario scenarios/dense.toml\n"
     "  corridor evaluate runs/first --world slip --set dynamics.friction=0.5\n"
     "  corridor evaluate runs/first --planners hierarchical,sumo --seeds 1002,1003 --json "
     "out.json",
     declare_evaluate, [](const Arguments& a) { return evaluate(a.evaluate); }},
    {"drive", "Drive an episode and show it: a film, a contact sheet and a player",
     "corridor drive runs/first --seed 1002\n"
     "  corridor drive runs/first --scenario scenarios/paper_substeps.toml --world slip\n"
     "  corridor drive runs/first --episode hierarchical_1002_3 --from 100 --seconds 20\n"
     "  corridor drive runs/first --planner rules --collisions",
     declare_drive, [](const Arguments& a) { return drive(a.drive); }},
    {"experiment", "Train and evaluate everything that an experiment file names, and go on with it",
     "corridor experiment scenarios/experiments/reduced.toml --run runs/reduced",
     [](CLI::App& app, Arguments& a) {
       app.add_option("FILE", a.experiment.file, "experiment file (TOML)")->required();
       app.add_option("--run", a.experiment.directory, "directory of the experiment")->required();
       declare_jobs(app, a.experiment.jobs, "cores to use (all)");
     },
     [](const Arguments& a) { return experiment(a.experiment, a.program); }},
    {"report", "Write a page with training curves, tables and settings, and the figures",
     "corridor report runs/first\n"
     "  corridor report runs/seed1 runs/seed2 runs/seed3 --out report",
     [](CLI::App& app, Arguments& a) {
       app.add_option("DIR", a.report.runs, "run directories; seeds of one training are one curve")
           ->required();
       app.add_option("--out", a.report.out,
                      "folder to write to; DIR/report of the first unless given");
     },
     [](const Arguments& a) { return report(a.report); }},
    {"export", "Copy a trained run's networks and settings, without all else",
     "corridor export runs/paper scenarios/trained/paper",
     [](CLI::App& app, Arguments& a) {
       declare_run(app, a.run);
       app.add_option("TO", a.exported, "run directory to create")->required();
     },
     [](const Arguments& a) {
       export_run(a.run, a.exported);
       return 0;
     }},
    {"hindsight", "Say how many collisions of an evaluation could have been avoided",
     "corridor hindsight runs/first\n"
     "  corridor hindsight runs/first/scenarios/dense --planners hierarchical,sumo --seeds 1002",
     declare_hindsight, [](const Arguments& a) { return hindsight(a.hindsight); }},
    {"fingerprint", "Print a hash over everything in the newest checkpoint",
     "corridor fingerprint runs/first",
     [](CLI::App& app, Arguments& a) { declare_run(app, a.run); }, run_fingerprint},
    {"redrive", "Drive a recorded episode again and compare the trajectories",
     "corridor redrive runs/first hierarchical_1002_3",
     [](CLI::App& app, Arguments& a) {
       declare_run(app, a.run);
       app.add_option("EPISODE", a.episode, "file, or name as in DIR/evaluation/episodes")
           ->required();
     },
     [](const Arguments& a) -> int { redrive(a.run, a.episode); }},
    {"check", "Say whether a scenario is right, and what it comes to",
     "corridor check scenarios/paper.toml\n"
     "  corridor check scenarios/smoke.toml --set mop.steps=3000",
     [](CLI::App& app, Arguments& a) {
       app.add_option("FILE", a.scenario, "scenario file (TOML)")->required();
       declare_settings(app, a.settings);
     },
     [](const Arguments& a) { return check(a.scenario, a.settings); }},
    {"completion", "Print a completion script, or a manual page",
     "corridor completion bash > ~/.local/share/bash-completion/completions/corridor\n"
     "  corridor completion man > corridor.1",
     [](CLI::App& app, Arguments& a) { declare_completion(app, a.format); },
     [](const Arguments& a) { return completion(*a.command_line, a.format); }},
};

// A first word that is no command.
void refuse_unknown(const char* word, const std::string& program) {
  if (word[0] == '-' || std::ranges::any_of(kCommands, [&](const Command& command) {
        return std::string_view(command.name) == word;
      })) {
    return;
  }
  throw Failure("there is no command '{}', but {}; see {} --help", word,
                listed(kCommands, ", ", &Command::name), program);
}

}  // namespace

int run_command(int argc, const char* const* argv) {
  CLI::App app("Trains and evaluates hierarchical planners for multi-lane cruising in SUMO traffic",
               "corridor");
  app.require_subcommand(1);
  app.footer("`corridor COMMAND --help` tells more, with examples.");
  Arguments arguments;
  arguments.program = argv[0];
  arguments.command_line = &app;
  if (argc > 1) refuse_unknown(argv[1], arguments.program);
  for (const Command& command : kCommands) {
    CLI::App* declared = app.add_subcommand(command.name, command.summary);
    declared->set_version_flag("--version", kVersion, "print the version");
    declared->footer(fmt::format("Examples:\n  {}", command.examples));
    command.declare(*declared, arguments);
    refuse_empty_values(*declared);
  }
  if (const auto done = parse_command_line(app, arguments.program, argc, argv)) return *done;
  const auto given = std::ranges::find_if(
      kCommands, [&](const Command& command) { return app.got_subcommand(command.name); });
  CORRIDOR_CHECK(given != std::end(kCommands), "a command is required and none was parsed");
  return given->run(arguments);
}

}  // namespace corridor::cluster
