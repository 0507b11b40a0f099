#include "cluster/results/hindsight_result.h"

#include <algorithm>

#include "cluster/results/statistics.h"
#include "proto/base/failure.h"
#include "proto/base/json.h"
#include "proto/base/text.h"

namespace corridor::cluster {
namespace {

constexpr const char* kAvoidable = "avoidable";
constexpr const char* kUnavoidable = "unavoidable";
constexpr const char* kUndecided = "undecided";

std::string verdict(const Json& value) {
  auto text = value.get<std::string>();
  if (text != kAvoidable && text != kUnavoidable && text != kUndecided) {
    throw Failure("'{}' is no verdict", text);
  }
  return text;
}

void add_collision(const Json& collision, HindsightResult& result) {
  const Json& by_last = collision.at("by_last_actions");
  if (!by_last.is_array() || by_last.size() != result.avoidable_by_last.size()) {
    throw Failure("a collision without {} verdicts", result.avoidable_by_last.size());
  }
  for (std::size_t i = 0; i < by_last.size(); ++i) {
    result.avoidable_by_last[i] += verdict(by_last[i]) == kAvoidable;
  }
  const std::string by_reacting = verdict(collision.at("by_reacting"));
  result.avoidable_by_reacting += by_reacting == kAvoidable;
  result.unavoidable_by_reacting += by_reacting == kUnavoidable;
  result.undecided += by_reacting == kUndecided;
  ++result.collisions;
}

std::vector<HindsightResult> by_planner(const std::vector<HindsightResult>& results) {
  std::vector<HindsightResult> sums;
  for (const HindsightResult& result : results) {
    const auto sum = std::ranges::find(sums, result.planner, &HindsightResult::planner);
    if (sum == sums.end()) {
      sums.push_back(result);
      continue;
    }
    sum->steps += result.steps;
    sum->collisions += result.collisions;
    for (std::size_t i = 0; i < sum->avoidable_by_last.size(); ++i) {
      sum->avoidable_by_last[i] += result.avoidable_by_last[i];
    }
    sum->avoidable_by_reacting += result.avoidable_by_reacting;
    sum->unavoidable_by_reacting += result.unavoidable_by_reacting;
    sum->undecided += result.undecided;
  }
  return sums;
}

Cell per_1000(std::int64_t count, std::int64_t steps) {
  const double scale = 1000.0 / static_cast<double>(steps);
  const Interval interval = poisson_interval(count);
  return {fmt::format("{:.2f}", static_cast<double>(count) * scale),
          fmt::format("[{:.2f}, {:.2f}]", interval.low * scale, interval.high * scale)};
}

Cell share(std::int64_t count, std::int64_t of) {
  if (of == 0) return {"-"};
  return {fmt::format("{:.1f}", 100.0 * static_cast<double>(count) / static_cast<double>(of))};
}

}  // namespace

HindsightResult parse_hindsight(const Json& report, const std::string& name) {
  HindsightResult result;
  try {
    report.at("planner").get_to(result.planner);
    result.seed = whole_number<std::uint64_t>(report.at("seed"));
    result.steps = whole_number<std::int64_t>(report.at("steps"));
    const int actions = whole_number<int>(report.at("actions"));
    if (result.steps < 1 || actions < 1 || actions > 100) {
      throw Failure("{} steps, {} actions", result.steps, actions);
    }
    result.avoidable_by_last.resize(static_cast<std::size_t>(actions));
    for (const Json& collision : report.at("collisions")) add_collision(collision, result);
  } catch (const std::exception& error) {
    throw Failure("{} is no hindsight: {}", name, error.what());
  }
  return result;
}

Table hindsight_table(const std::vector<HindsightResult>& results) {
  CORRIDOR_CHECK(!results.empty(), "no results");
  const std::size_t actions = results.front().avoidable_by_last.size();
  Table table{"Avoidable collisions, with 95 % intervals", {"planner", "collisions"}, {}};
  for (std::size_t i = 1; i <= actions; ++i) {
    table.columns.push_back(fmt::format("% by last {}", i));
  }
  for (const char* column : {"% by reacting", "floor", "undecided"})
    table.columns.push_back(column);
  for (const HindsightResult& result : by_planner(results)) {
    CORRIDOR_CHECK(result.avoidable_by_last.size() == actions, "{} and {} actions",
                   result.avoidable_by_last.size(), actions);
    std::vector<Cell> row = {{result.planner}, per_1000(result.collisions, result.steps)};
    for (const std::int64_t count : result.avoidable_by_last) {
      row.push_back(share(count, result.collisions));
    }
    row.push_back(share(result.avoidable_by_reacting, result.collisions));
    row.push_back(per_1000(result.unavoidable_by_reacting, result.steps));
    row.push_back({grouped(result.undecided)});
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
