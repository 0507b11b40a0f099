// SPDX-License-Identifier: Apache-2.0
#include "cluster/results/results_tables.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "proto/base/failure.h"
#include "proto/base/text.h"

namespace corridor::cluster {
namespace {

constexpr const char* kNothing = "-";

struct PaperRow {
  const char* planners;
  std::array<double, 4> values;  // in the order of kCompared; hard brakes are not in it
};
constexpr PaperRow kPaper[] = {
    {"hierarchical RL", {699, 2.125, 25.0, 43.21}},
    {"rule-based BP and MoP", {627, 3.525, 73.0, 44.24}},
    {"rule-based BP with DQN MoP", {531, 3.350, 79.2, 41.29}},
    {"SUMO controlling the ego", {511, 1.625, 88.3, 41.78}},
};
constexpr const PaperRow& kPaperHierarchical = kPaper[0];
constexpr const PaperRow& kPaperRules = kPaper[1];
constexpr const PaperRow& kPaperSumo = kPaper[3];

std::string number(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : kNothing;
}

Cell cell(const Estimate& estimate, int digits) {
  return {number(estimate.value, digits),
          fmt::format("[{}, {}]", number(estimate.interval.low, digits),
                      number(estimate.interval.high, digits))};
}

// One row an arm, which says its planner.
Table table_of(const char* title, const std::vector<Arm>& arms) {
  Table table{title, {"planner"}, {}};
  for (const Arm& arm : arms) table.rows.push_back({{arm.planner}});
  return table;
}

// A column more: what `cell_of` says of each arm.
template <typename CellOf>
void add_column(Table& table, const char* column, const std::vector<Arm>& arms,
                const CellOf& cell_of) {
  table.columns.push_back(column);
  for (std::size_t i = 0; i < arms.size(); ++i) table.rows[i].push_back(cell_of(arms[i]));
}

void add_column(Table& table, const char* column, const std::vector<Arm>& arms, Quantity quantity,
                int digits) {
  add_column(table, column, arms, [&](const Arm& arm) { return cell(arm[quantity], digits); });
}

Table sums_table(const std::vector<Arm>& arms) {
  Table table = table_of("Sums per 1000 steps, with 95 % intervals", arms);
  add_column(table, "BP reward", arms, Quantity::kBpReward, 0);
  add_column(table, "collisions", arms, Quantity::kCollisions, 2);
  add_column(table, "lane changes", arms, Quantity::kLaneChanges, 1);
  add_column(table, "km/h", arms, Quantity::kSpeed, 1);
  add_column(table, "hard brakes", arms, Quantity::kHardBrakes, 1);
  table.note =
      std::ranges::any_of(arms, [](const Arm& arm) { return arm.training_seeds > 1; })
          ? "Collisions: all seeds together, exact Poisson. The rest: interquartile mean over "
            "training seeds and bootstrap over them; where nothing is learned, or with one "
            "training seed, mean and bootstrap over episodes."
          : "Intervals: collisions exact Poisson, the rest bootstrap over episodes; they say "
            "nothing about another training seed.";
  return table;
}

Table kinds_table(const std::vector<Arm>& arms) {
  Table table = table_of("Collisions per 1000 steps by kind", arms);
  add_column(table, "count", arms, [](const Arm& arm) { return Cell{grouped(arm.collisions)}; });
  add_column(table, "rear-ended", arms, Quantity::kRearEnded, 2);
  add_column(table, "rear-ending", arms, Quantity::kRearEnding, 2);
  add_column(table, "side by other", arms, Quantity::kSideByOther, 2);
  add_column(table, "side by ego", arms, Quantity::kSideByEgo, 2);
  // Only a car with dynamics of its own can leave the road.
  if (std::ranges::any_of(arms, [](const Arm& a) { return a[Quantity::kOffRoad].value > 0.0; }))
    add_column(table, "off the road", arms, Quantity::kOffRoad, 2);
  return table;
}

Table distance_table(const std::vector<Arm>& arms) {
  Table table = table_of("Per km, lanes and seeds", arms);
  add_column(table, "km", arms, [](const Arm& arm) { return Cell{number(arm.distance_km, 0)}; });
  add_column(table, "collisions/km", arms, Quantity::kCollisionsPerKm, 3);
  add_column(table, "lane changes/km", arms, Quantity::kLaneChangesPerKm, 2);
  add_column(table, "bypasses/km", arms, Quantity::kBypassesPerKm, 2);
  add_column(table, "lanes %, right first", arms, [](const Arm& arm) {
    std::vector<std::string> lanes;
    for (const double share : arm.lane_shares) lanes.push_back(number(100.0 * share, 0));
    return Cell{listed(lanes, " / ")};
  });
  add_column(table, "training seeds", arms, [](const Arm& arm) {
    return Cell{arm.training_seeds == 0 ? kNothing : std::to_string(arm.training_seeds)};
  });
  add_column(table, "evaluation seeds", arms,
             [](const Arm& arm) { return Cell{std::to_string(arm.evaluation_seeds)}; });
  return table;
}

// A table more, where there are such ratios.
void add_ratios(std::vector<Table>& tables, const std::vector<Arm>& arms, const char* baseline,
                std::optional<Ratios> Arm::*ratios, const PaperRow& paper) {
  Table table{fmt::format("Ratios to {}", baseline),
              {"planner", "BP reward", "collisions", "lane changes", "km/h", "hard brakes"},
              {}};
  for (const Arm& arm : arms) {
    if (!(arm.*ratios)) continue;
    std::vector<Cell> row = {{arm.planner}};
    for (const auto& ratio : *(arm.*ratios))
      row.push_back(ratio ? cell(*ratio, 2) : Cell{kNothing});
    table.rows.push_back(std::move(row));
  }
  if (table.rows.empty()) return;
  std::vector<Cell> row = {{"the paper's hierarchical RL"}};
  for (std::size_t i = 0; i < paper.values.size(); ++i) {
    row.push_back({number(kPaperHierarchical.values[i] / paper.values[i], 2)});
  }
  row.push_back({kNothing});
  table.rows.push_back(std::move(row));
  tables.push_back(std::move(table));
}

// All seeds of a planner as one record.
std::vector<HindsightRecord> by_planner(const std::vector<HindsightRecord>& records) {
  std::vector<HindsightRecord> all;
  for (const HindsightRecord& record : records) {
    const auto same = std::ranges::find(all, record.planner, &HindsightRecord::planner);
    if (same == all.end()) {
      all.push_back(record);
      continue;
    }
    same->steps += record.steps;
    same->collisions.insert(same->collisions.end(), record.collisions.begin(),
                            record.collisions.end());
  }
  return all;
}

Cell per_1000(std::int64_t count, std::int64_t steps) {
  const double scale = 1000.0 / static_cast<double>(steps);
  const auto [low, high] = poisson_interval(count);
  return cell({static_cast<double>(count) * scale, {low * scale, high * scale}}, 2);
}

Cell percent(std::int64_t count, std::int64_t of) {
  if (of == 0) return {kNothing};
  return {number(100.0 * static_cast<double>(count) / static_cast<double>(of), 1)};
}

}  // namespace

std::vector<Table> results_tables(const std::vector<Arm>& arms) {
  std::vector<Table> tables = {sums_table(arms), kinds_table(arms), distance_table(arms)};
  add_ratios(tables, arms, kRules, &Arm::to_rules, kPaperRules);
  add_ratios(tables, arms, kSumo, &Arm::to_sumo, kPaperSumo);
  return tables;
}

std::string world_text(const RunConfig& config) {
  const TrafficSettings& traffic = config.traffic;
  const SimulationSettings& simulation = config.simulation;
  std::string text = fmt::format("{} to {} vehicles within {:g} m of the ego", traffic.vehicles_min,
                                 traffic.vehicles_max, traffic.window_m);
  text += traffic.blind_rate_per_s > 0.0
              ? fmt::format("; {:g} a second move into its lane without looking",
                            traffic.blind_rate_per_s)
              : std::string("; all of them look before they move over");
  if (traffic.objects_per_km > 0.0) {
    text += fmt::format("; {:g} objects per km at a lane's edge", traffic.objects_per_km);
  }
  if (config.dynamics.world != WorldKind::kKinematic) {
    text += fmt::format("; dynamics.world = \"{}\"", name_of(config.dynamics.world));
  }
  text += fmt::format(". A step is {:g} s, collisions are looked for every {:g} s.",
                      simulation.step_s, simulation.substep_s());
  return text;
}

Table paper_table() {
  Table table{"The paper's Table I, for comparison",
              {"planner", "BP reward", "collisions", "lane changes", "km/h"},
              {},
              "Its own traffic, one policy, 40,000 steps, no intervals."};
  constexpr std::array kDigits = {0, 3, 1, 2};
  for (const PaperRow& paper : kPaper) {
    std::vector<Cell> row = {{paper.planners}};
    for (std::size_t i = 0; i < kDigits.size(); ++i)
      row.push_back({number(paper.values[i], kDigits[i])});
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table hindsight_table(const std::vector<HindsightRecord>& records) {
  CORRIDOR_CHECK(!records.empty(), "no records");
  const int actions = records.front().limits.actions;
  for (const HindsightRecord& record : records) {
    CORRIDOR_CHECK(record.limits.actions == actions, "{} and {} actions", record.limits.actions,
                   actions);
  }
  Table table{"Avoidable collisions, with 95 % intervals", {"planner", "collisions"}, {}};
  for (int i = 1; i <= actions; ++i) table.columns.push_back(fmt::format("% by last {}", i));
  for (const char* column : {"% by reacting", "floor", "undecided"})
    table.columns.push_back(column);
  for (const HindsightRecord& record : by_planner(records)) {
    const auto count = [&](Verdict verdict, const auto& verdict_of) {
      return std::ranges::count(record.collisions, verdict, verdict_of);
    };
    const auto all = std::ssize(record.collisions);
    const auto by_reacting = &CollisionHindsight::by_reacting;
    std::vector<Cell> row = {{record.planner}, per_1000(all, record.steps)};
    for (std::size_t i = 0; i < static_cast<std::size_t>(actions); ++i) {
      const auto by_last = [&](const auto& collision) { return collision.by_last_actions.at(i); };
      row.push_back(percent(count(Verdict::kAvoidable, by_last), all));
    }
    row.push_back(percent(count(Verdict::kAvoidable, by_reacting), all));
    row.push_back(per_1000(count(Verdict::kUnavoidable, by_reacting), record.steps));
    row.push_back({grouped(count(Verdict::kUndecided, by_reacting))});
    table.rows.push_back(std::move(row));
  }
  table.note =
      "Collisions and floor per 1000 steps, intervals exact Poisson. By last k: the MoP's last k\n"
      "actions, chosen with foresight, could have avoided it. By reacting: those chosen once the\n"
      "other vehicle had visibly begun, or was in the way, could have. Floor: no such reaction\n"
      "could have; that foresight or another way of driving avoids them is not excluded.";
  return table;
}

}  // namespace corridor::cluster
