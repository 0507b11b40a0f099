#include "cluster/report/report_page.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <tuple>

#include "cluster/report/html.h"
#include "cluster/results/results_tables.h"
#include "proto/base/format.h"
#include "proto/base/text.h"
#include "proto/config/config_values.h"
#include "proto/settings/schedule.h"

namespace corridor::cluster {
namespace {

constexpr const char* kUnknown = "-";

std::string steps_text(const RunRecord& run) {
  const Schedule schedule(run.config);
  const auto steps = [&](std::uint64_t rounds) {
    return grouped(static_cast<std::int64_t>(rounds) * schedule.steps_per_round());
  };
  return run.rounds_done >= schedule.rounds()
             ? steps(run.rounds_done)
             : fmt::format("{} of {}", steps(run.rounds_done), steps(schedule.rounds()));
}

Table runs_table(const std::vector<RunGroup>& groups) {
  Table table{
      "Runs", {"run", "training", "seed", "steps in the newest checkpoint", "its fingerprint"}, {}};
  for (const RunGroup& group : groups) {
    for (const RunRecord& run : group.runs) {
      table.rows.push_back({{run.root.string()},
                            {group.label},
                            {std::to_string(run.config.run.seed)},
                            {steps_text(run)},
                            {run.fingerprint.value_or(kUnknown)}});
    }
  }
  return table;
}

// One column a run.
Table making_table(const std::vector<RunGroup>& groups) {
  Table table{"Made with", {""}, {}};
  std::vector<const RunRecord*> runs;
  for (const RunGroup& group : groups) {
    for (const RunRecord& run : group.runs) runs.push_back(&run);
  }
  for (const RunRecord* run : runs) table.columns.push_back(run->root.string());
  for (const auto& [name, value] : runs.front()->made_with) {
    std::vector<Cell> row = {{name}};
    for (const RunRecord* run : runs) {
      const auto other =
          std::ranges::find(run->made_with, name, [](const auto& pair) { return pair.first; });
      row.push_back({other == run->made_with.end() ? kUnknown : other->second});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::set<std::string> worlds_of(const RunGroup& group) {
  std::set<std::string> worlds;
  for (const RunRecord& run : group.runs) {
    for (const auto& [world, results] : run.evaluations) worlds.insert(world);
  }
  return worlds;
}

std::string tables_of(const RunGroup& group, const std::string& world) {
  std::vector<SeedResult> results;
  for (const RunRecord& run : group.runs) {
    const auto in_world = run.evaluations.find(world);
    if (in_world == run.evaluations.end()) continue;
    for (const EvaluationRecord& result : in_world->second) {
      results.push_back({run.config.run.seed, result});
    }
  }
  std::string html = html_heading(
      3, world.empty() ? group.label : fmt::format("{}, driving in {}", group.label, world));
  for (const Table& table : results_tables(arms_of(results))) html += html_of(table);
  return html;
}

// As one word of a shell.
std::string shell_word(const std::string& text) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) ||
           std::string_view("/._-+,=:").find(static_cast<char>(c)) != std::string_view::npos;
  };
  if (!text.empty() && std::ranges::all_of(text, plain)) return text;
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

// One command for all planners of equal steps and seeds.
std::string evaluate_commands(const std::vector<EvaluationRecord>& results, const std::string& run,
                              const std::string& scenario) {
  std::map<std::string, std::map<std::int64_t, std::vector<std::uint64_t>>> seeds;
  for (const EvaluationRecord& result : results) {
    seeds[result.planner][result.steps].push_back(result.seed);
  }
  std::map<std::pair<std::int64_t, std::vector<std::uint64_t>>, std::vector<std::string>> planners;
  for (auto& [planner, of_steps] : seeds) {
    for (auto& [steps, of_planner] : of_steps) {
      std::ranges::sort(of_planner);
      planners[{steps, of_planner}].push_back(planner);
    }
  }
  std::string text;
  for (const auto& [key, names] : planners) {
    const auto& [steps, of_planners] = key;
    std::vector<std::string> seed_texts;
    for (const std::uint64_t seed : of_planners) seed_texts.push_back(std::to_string(seed));
    text += fmt::format("corridor evaluate {}{} --planners {} --seeds {} --steps {}\n", run,
                        scenario, listed(names, ","), listed(seed_texts, ","), steps);
  }
  return text;
}

// Of another training: in what it differs from the first.
std::string differences(const RunConfig& first, const RunConfig& other) {
  std::string text;
  for (const ChangedKey& key : changed_keys(first, other)) {
    text += fmt::format("{} = {}    # {} in the first\n", key.name, key.now, key.before);
  }
  return text;
}

}  // namespace

std::string repeating_commands(const RunRecord& run) {
  const std::string again = shell_word(
      (run.root.filename().empty() ? run.root.parent_path() : run.root).filename().string() +
      "-again");
  std::string text = fmt::format("corridor train {} --run {}\n",
                                 shell_word((run.root / "config.toml").string()), again);
  if (run.fingerprint && run.rounds_done >= Schedule(run.config).rounds()) {
    text += fmt::format("corridor fingerprint {}    # {}\n", again, *run.fingerprint);
  }
  for (const auto& [world, results] : run.evaluations) {
    std::string scenario;
    if (!world.empty()) {
      const std::string file = shell_word(world + ".toml");
      text += fmt::format("cp {} {}\n", shell_word((run.driven_in(world) / "config.toml").string()),
                          file);
      scenario = " --scenario " + file;
    }
    text += evaluate_commands(results, again, scenario);
  }
  return text;
}

std::string report_page(const std::vector<RunGroup>& groups,
                        const std::vector<DrawnFigure>& training,
                        const std::vector<DrawnFigure>& episodes) {
  std::vector<std::string> labels;
  for (const RunGroup& group : groups) labels.push_back(group.label);
  std::string body = html_of(runs_table(groups));

  body += html_heading(2, "Training");
  for (const DrawnFigure& drawn : training) body += html_figure(drawn.svg, drawn.caption);

  body += html_heading(2, "Evaluation");
  bool evaluated = false;
  for (const RunGroup& group : groups) {
    for (const std::string& world : worlds_of(group)) {
      body += tables_of(group, world);
      evaluated = true;
    }
  }
  body += evaluated ? html_of(paper_table())
                    : html_paragraph(
                          "None yet: corridor evaluate drives the planners on held-out "
                          "traffic.");

  if (!episodes.empty()) body += html_heading(2, "Episodes");
  for (const DrawnFigure& drawn : episodes) body += html_figure(drawn.svg, drawn.caption);

  body += html_heading(2, "Repeating it");
  body += html_paragraph(
      "With the versions below each command gives the same bits, on any x86-64 processor with "
      "AVX2.");
  for (const RunGroup& group : groups) {
    for (const RunRecord& run : group.runs) body += html_preformatted(repeating_commands(run));
  }
  body += html_of(making_table(groups));

  body += html_heading(2, "Settings");
  const RunConfig& first = groups.front().runs.front().config;
  body += html_folded(groups.front().label + ", config.toml", to_toml(first));
  for (const RunGroup& group : groups) {
    const std::string differs = differences(first, group.runs.front().config);
    if (!differs.empty()) {
      body += html_heading(3, group.label + " differs in") + html_preformatted(differs);
    }
  }
  return html_document("corridor: " + listed(labels), body);
}

}  // namespace corridor::cluster
