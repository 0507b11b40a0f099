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
  // In the order of kCompared; hard brakes are not in it.
  double bp_reward, collisions, lane_changes, speed_kph;

  std::array<double, 4> values() const { return {bp_reward, collisions, lane_changes, speed_kph}; }
};
constexpr PaperRow kPaper[] = {
    {"hierarchical RL", 699, 2.125, 25.0, 43.21},
    {"rule-based BP and MoP", 627, 3.525, 73.0, 44.24},
    {"rule-based BP with DQN MoP", 531, 3.350, 79.2, 41.29},
    {"SUMO controlling the ego", 511, 1.625, 88.3, 41.78},
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

Table sums_table(const std::vector<Arm>& arms) {
  Table table{"Sums per 1000 steps, with 95 % intervals",
              {"planner", "BP reward", "collisions", "lane changes", "km/h", "hard brakes"},
              {}};
  bool over_seeds = false;
  for (const Arm& arm : arms) {
    over_seeds |= arm.training_seeds > 1;
    table.rows.push_back({{arm.planner},
                          cell(arm[Quantity::kBpReward], 0),
                          cell(arm[Quantity::kCollisions], 2),
                          cell(arm[Quantity::kLaneChanges], 1),
                          cell(arm[Quantity::kSpeed], 1),
                          cell(arm[Quantity::kHardBrakes], 1)});
  }
  table.note =
      over_seeds
          ? "Collisions: all seeds together, exact Poisson. The rest: interquartile mean over "
            "training seeds and bootstrap over them; where nothing is learned, or with one "
            "training seed, mean and bootstrap over episodes."
          : "Intervals: collisions exact Poisson, the rest bootstrap over episodes; they say "
            "nothing about another training seed.";
  return table;
}

Table kinds_table(const std::vector<Arm>& arms) {
  Table table{"Collisions per 1000 steps by kind",
              {"planner", "count", "rear-ended", "rear-ending", "side by other", "side by ego"},
              {}};
  for (const Arm& arm : arms) {
    table.rows.push_back({{arm.planner},
                          {grouped(arm.collisions)},
                          cell(arm[Quantity::kRearEnded], 2),
                          cell(arm[Quantity::kRearEnding], 2),
                          cell(arm[Quantity::kSideByOther], 2),
                          cell(arm[Quantity::kSideByEgo], 2)});
  }
  // Only a car with dynamics of its own can leave the road.
  if (std::ranges::any_of(arms, [](const Arm& a) { return a[Quantity::kOffRoad].value > 0.0; })) {
    table.columns.push_back("off the road");
    for (std::size_t i = 0; i < arms.size(); ++i) {
      table.rows[i].push_back(cell(arms[i][Quantity::kOffRoad], 2));
    }
  }
  return table;
}

Table distance_table(const std::vector<Arm>& arms) {
  Table table{"Per km, lanes and seeds",
              {"planner", "km", "collisions/km", "lane changes/km", "bypasses/km",
               "lanes %, right first", "training seeds", "evaluation seeds"},
              {}};
  for (const Arm& arm : arms) {
    std::string lanes;
    for (const double share : arm.lane_shares) {
      lanes += fmt::format("{}{:.0f}", lanes.empty() ? "" : " / ", 100.0 * share);
    }
    table.rows.push_back({{arm.planner},
                          {number(arm.distance_km, 0)},
                          cell(arm[Quantity::kCollisionsPerKm], 3),
                          cell(arm[Quantity::kLaneChangesPerKm], 2),
                          cell(arm[Quantity::kBypassesPerKm], 2),
                          {lanes},
                          {arm.training_seeds == 0 ? kNothing : std::to_string(arm.training_seeds)},
                          {std::to_string(arm.evaluation_seeds)}});
  }
  return table;
}

std::optional<Table> ratio_table(const std::vector<Arm>& arms, const char* baseline,
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
  if (table.rows.empty()) return std::nullopt;
  std::vector<Cell> row = {{"the paper's hierarchical RL"}};
  for (std::size_t i = 0; i < paper.values().size(); ++i) {
    row.push_back({number(kPaperHierarchical.values()[i] / paper.values()[i], 2)});
  }
  row.push_back({kNothing});
  table.rows.push_back(std::move(row));
  return table;
}

}  // namespace

std::vector<Table> results_tables(const std::vector<Arm>& arms) {
  std::vector<Table> tables = {sums_table(arms), kinds_table(arms), distance_table(arms)};
  for (auto& table : {ratio_table(arms, kRules, &Arm::to_rules, kPaperRules),
                      ratio_table(arms, kSumo, &Arm::to_sumo, kPaperSumo)}) {
    if (table) tables.push_back(*table);
  }
  return tables;
}

Table paper_table() {
  Table table{"The paper's Table I, for comparison",
              {"planner", "BP reward", "collisions", "lane changes", "km/h"},
              {},
              "Its own traffic, one policy, 40,000 steps, no intervals."};
  for (const PaperRow& row : kPaper) {
    table.rows.push_back({{row.planners},
                          {number(row.bp_reward, 0)},
                          {number(row.collisions, 3)},
                          {number(row.lane_changes, 1)},
                          {number(row.speed_kph, 2)}});
  }
  return table;
}

}  // namespace corridor::cluster
