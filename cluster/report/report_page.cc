// SPDX-License-Identifier: Apache-2.0
#include "cluster/report/report_page.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "cluster/results/results_tables.h"
#include "proto/base/failure.h"
#include "proto/base/text.h"
#include "proto/config/config_values.h"
#include "proto/settings/schedule.h"

namespace corridor::cluster {
namespace {

constexpr const char* kStyle = R"(
body { max-width: 72rem; margin: 2rem auto; padding: 0 1rem; color: #222;
       font: 15px/1.45 Helvetica, Arial, sans-serif; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.25rem; margin-top: 2.2rem; } h3 { font-size: 1.05rem; }
figure { margin: 1.2rem 0; } figure > svg { width: 100%; height: auto; }
figcaption, .note { color: #555; font-size: 0.9rem; }
.table { overflow-x: auto; margin: 1rem 0; }
table { border-collapse: collapse; font-size: 0.9rem; font-variant-numeric: tabular-nums; }
caption { text-align: left; font-weight: bold; padding-bottom: 0.3rem; }
thead th { border-top: 1.5px solid #222; border-bottom: 1px solid #222; vertical-align: bottom; }
tbody tr:last-child > * { border-bottom: 1.5px solid #222; }
th, td { padding: 0.2rem 0.8rem 0.2rem 0; text-align: right; font-weight: normal; }
th:first-child { text-align: left; } td small { color: #666; }
pre { background: #f5f5f5; padding: 0.7rem; overflow-x: auto; font-size: 0.85rem; }
summary { cursor: pointer; }
@media print { body { max-width: none; } figure { break-inside: avoid; } }
)";

constexpr const char* kUnknown = "-";

std::string element(const char* name, const std::string& text) {
  return fmt::format("<{0}>{1}</{0}>\n", name, html_escaped(text));
}

std::string html_figure(const DrawnFigure& figure) {
  // What is before belongs to an XML document of its own.
  const std::size_t start = std::min(figure.svg.find("<svg"), figure.svg.size());
  return "<figure>\n" + figure.svg.substr(start) + element("figcaption", figure.caption) +
         "</figure>\n";
}

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

// For each world that its runs drove in.
std::string evaluation_tables(const RunGroup& group) {
  std::map<std::string, std::vector<SeedResult>> by_world;
  for (const RunRecord& run : group.runs) {
    for (const auto& [world, results] : run.evaluations) {
      for (const EvaluationRecord& result : results)
        by_world[world].push_back({run.config.run.seed, result});
    }
  }
  std::string html;
  for (const auto& [world, results] : by_world) {
    html += element(
        "h3", world.empty() ? group.label : fmt::format("{}, driving in {}", group.label, world));
    const RunConfig* config = nullptr;  // its settings are the same in all runs of the group
    for (const RunRecord& run : group.runs) {
      const auto driven = run.worlds.find(world);
      if (driven != run.worlds.end()) config = &driven->second;
    }
    CORRIDOR_CHECK(config != nullptr, "{}", world);
    html += element("p", world_text(*config));
    for (const Table& table : results_tables(arms_of(results))) html += html_of(table);
  }
  return html;
}

// One command for all planners of equal steps and seeds.
std::string evaluate_commands(const std::vector<EvaluationRecord>& results, const std::string& run,
                              const std::string& scenario) {
  std::map<std::pair<std::string, std::int64_t>, std::vector<std::uint64_t>> seeds;
  for (const EvaluationRecord& result : results)
    seeds[{result.planner, result.steps}].push_back(result.seed);
  std::map<std::pair<std::int64_t, std::vector<std::uint64_t>>, std::vector<std::string>> planners;
  for (auto& [key, of_planner] : seeds) {
    std::ranges::sort(of_planner);
    planners[{key.second, of_planner}].push_back(key.first);
  }
  std::string text;
  for (const auto& [key, names] : planners) {
    const auto& [steps, of_planners] = key;
    text += fmt::format("corridor evaluate {}{} --planners {} --seeds {} --steps {}\n", run,
                        scenario, listed(names, ","), listed(of_planners, ","), steps);
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
  const std::string again = shell_quoted(
      (run.root.filename().empty() ? run.root.parent_path() : run.root).filename().string() +
      "-again");
  std::string text = fmt::format("corridor train {} --run {}\n",
                                 shell_quoted((run.root / "config.toml").string()), again);
  if (run.fingerprint && run.rounds_done >= Schedule(run.config).rounds()) {
    text += fmt::format("corridor fingerprint {}    # {}\n", again, *run.fingerprint);
  }
  for (const auto& [world, results] : run.evaluations) {
    std::string scenario;
    if (!world.empty()) {
      const std::string file = shell_quoted(world + ".toml");
      text += fmt::format("cp {} {}\n",
                          shell_quoted((run.driven_in(world) / "config.toml").string()), file);
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

  body += element("h2", "Training");
  for (const DrawnFigure& drawn : training) body += html_figure(drawn);

  body += element("h2", "Evaluation");
  std::string evaluations;
  for (const RunGroup& group : groups) evaluations += evaluation_tables(group);
  body += evaluations.empty() ? element("p",
                                        "None yet: corridor evaluate drives the planners on "
                                        "held-out traffic.")
                              : evaluations + html_of(paper_table());

  if (!episodes.empty()) body += element("h2", "Episodes");
  for (const DrawnFigure& drawn : episodes) body += html_figure(drawn);

  body += element("h2", "Repeating it");
  body += element(
      "p",
      "With the versions below each command gives the same bits, on any x86-64 processor with "
      "AVX2.");
  for (const RunGroup& group : groups) {
    for (const RunRecord& run : group.runs) body += element("pre", repeating_commands(run));
  }
  body += html_of(making_table(groups));

  body += element("h2", "Settings");
  const RunConfig& first = groups.front().runs.front().config;
  body += "<details>" + element("summary", groups.front().label + ", config.toml") +
          element("pre", to_toml(first)) + "</details>\n";
  for (const RunGroup& group : groups) {
    const std::string differs = differences(first, group.runs.front().config);
    if (!differs.empty()) {
      body += element("h3", group.label + " differs in") + element("pre", differs);
    }
  }
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n{3}\n"
      "<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n<h1>{0}</h1>\n{2}</body>\n"
      "</html>\n",
      html_escaped("corridor: " + listed(labels)), kStyle, body, kGenerator);
}

}  // namespace corridor::cluster
