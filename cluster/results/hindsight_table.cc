#include "cluster/results/hindsight_table.h"

#include <algorithm>

#include "cluster/results/statistics.h"
#include "proto/base/failure.h"
#include "proto/base/text.h"

namespace corridor::cluster {
namespace {

// A planner's, of all its seeds.
struct Counts {
  std::string planner;
  std::int64_t steps = 0;
  std::int64_t collisions = 0;
  std::vector<std::int64_t> avoidable_by_last;  // by the last 1, 2, ... actions
  std::int64_t avoidable_by_reacting = 0;       // to what could be seen
  std::int64_t unavoidable_by_reacting = 0;
  std::int64_t undecided = 0;  // neither of the two: a search was given up
};

void add(const HindsightRecord& record, Counts& counts) {
  counts.steps += record.steps;
  for (const CollisionHindsight& collision : record.collisions) {
    for (std::size_t i = 0; i < counts.avoidable_by_last.size(); ++i) {
      counts.avoidable_by_last[i] += collision.by_last_actions.at(i) == Verdict::kAvoidable;
    }
    counts.avoidable_by_reacting += collision.by_reacting == Verdict::kAvoidable;
    counts.unavoidable_by_reacting += collision.by_reacting == Verdict::kUnavoidable;
    counts.undecided += collision.by_reacting == Verdict::kUndecided;
    ++counts.collisions;
  }
}

std::vector<Counts> by_planner(const std::vector<HindsightRecord>& records, std::size_t actions) {
  std::vector<Counts> all;
  for (const HindsightRecord& record : records) {
    auto counts = std::ranges::find(all, record.planner, &Counts::planner);
    if (counts == all.end()) {
      counts = all.insert(all.end(), {.planner = record.planner,
                                      .avoidable_by_last = std::vector<std::int64_t>(actions)});
    }
    add(record, *counts);
  }
  return all;
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
  for (const Counts& counts : by_planner(records, static_cast<std::size_t>(actions))) {
    std::vector<Cell> row = {{counts.planner}, per_1000(counts.collisions, counts.steps)};
    for (const std::int64_t count : counts.avoidable_by_last) {
      row.push_back(share(count, counts.collisions));
    }
    row.push_back(share(counts.avoidable_by_reacting, counts.collisions));
    row.push_back(per_1000(counts.unavoidable_by_reacting, counts.steps));
    row.push_back({grouped(counts.undecided)});
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
