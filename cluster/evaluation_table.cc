#include "cluster/evaluation_table.h"

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>

#include "cluster/statistics.h"
#include "cluster/text.h"
#include "proto/failure.h"
#include "proto/json_numbers.h"

namespace corridor::cluster {
namespace {

using nlohmann::json;

template <typename T>
void read(const json& value, T& into) {
  if constexpr (std::integral<T>) {
    into = whole_number<T>(value);
  } else {
    value.get_to(into);
  }
}

EpisodeResult parse_episode(const json& entry) {
  EpisodeResult result;
  read(entry.at("steps"), result.steps);
  read(entry.at("bp_reward"), result.bp_reward);
  read(entry.at("collisions"), result.collisions);
  read(entry.at("lane_changes"), result.lane_changes);
  read(entry.at("hard_brakes"), result.hard_brakes);
  read(entry.at("distance_m"), result.distance_m);
  result.lane_steps = whole_numbers<std::int64_t>(entry.at("lane_steps"));
  return result;
}

// All episodes of one planner, over its seeds.
struct Row {
  std::string planner;
  std::vector<EpisodeResult> episodes;
  std::array<std::int64_t, kCollisionKinds.size()> collisions_by_kind{};

  double sum(const std::function<double(const EpisodeResult&)>& value) const {
    double total = 0.0;
    for (const EpisodeResult& episode : episodes) total += value(episode);
    return total;
  }
  double steps() const {
    return sum([](const EpisodeResult& e) { return static_cast<double>(e.steps); });
  }
  double km() const {
    return sum([](const EpisodeResult& e) { return e.distance_m / 1000.0; });
  }
  std::int64_t collisions() const {
    std::int64_t total = 0;
    for (const EpisodeResult& episode : episodes) total += episode.collisions;
    return total;
  }
};

std::vector<Row> rows_of(const std::vector<EvaluationResult>& results) {
  std::vector<Row> rows;
  for (const EvaluationResult& result : results) {
    auto row = std::find_if(rows.begin(), rows.end(),
                            [&](const Row& r) { return r.planner == result.planner; });
    if (row == rows.end()) row = rows.insert(row, Row{result.planner, {}, {}});
    row->episodes.insert(row->episodes.end(), result.per_episode.begin(), result.per_episode.end());
    for (std::size_t kind = 0; kind < kCollisionKinds.size(); ++kind) {
      row->collisions_by_kind[kind] += result.collisions_by_kind[kind];
    }
  }
  return rows;
}

// `scale` * sum(value) / sum(steps), and its interval over episodes.
std::string ratio_cell(const Row& row, double scale, int digits, std::uint64_t seed,
                       const std::function<double(const EpisodeResult&)>& value) {
  std::vector<double> numerators, denominators;
  for (const EpisodeResult& episode : row.episodes) {
    numerators.push_back(scale * value(episode));
    denominators.push_back(static_cast<double>(episode.steps));
  }
  const Interval interval = bootstrap_ratio_interval(numerators, denominators, seed);
  return fmt::format("{:.{}f} [{:.{}f}, {:.{}f}]", scale * row.sum(value) / row.steps(), digits,
                     interval.low, digits, interval.high, digits);
}

std::string collision_cell(const Row& row) {
  const Interval interval = poisson_interval(row.collisions());
  const double per_1000 = 1000.0 / row.steps();
  return fmt::format("{:.2f} [{:.2f}, {:.2f}]", static_cast<double>(row.collisions()) * per_1000,
                     interval.low * per_1000, interval.high * per_1000);
}

std::string lane_shares(const Row& row) {
  std::vector<double> steps;
  for (const EpisodeResult& episode : row.episodes) {
    steps.resize(std::max(steps.size(), episode.lane_steps.size()));
    for (std::size_t lane = 0; lane < episode.lane_steps.size(); ++lane) {
      steps[lane] += static_cast<double>(episode.lane_steps[lane]);
    }
  }
  double total = 0.0;
  for (const double lane : steps) total += lane;
  std::string text;
  for (const double lane : steps) {
    text +=
        fmt::format("{}{:.0f}", text.empty() ? "" : " / ", total > 0 ? 100.0 * lane / total : 0);
  }
  return text;
}

std::string sums_table(const std::vector<Row>& rows, double step_s, std::uint64_t seed) {
  constexpr double kKphPerMps = 3.6;
  std::string text = fmt::format("{:<14}{:<20}{:<20}{:<20}{}\n", "planner", "BP reward",
                                 "collisions", "lane changes", "km/h");
  for (const Row& row : rows) {
    text += fmt::format(
        "{:<14}{:<20}{:<20}{:<20}{}\n", row.planner,
        ratio_cell(row, 1000.0, 0, seed, [](const EpisodeResult& e) { return e.bp_reward; }),
        collision_cell(row),
        ratio_cell(row, 1000.0, 1, seed,
                   [](const EpisodeResult& e) { return static_cast<double>(e.lane_changes); }),
        ratio_cell(row, kKphPerMps / step_s, 1, seed,
                   [](const EpisodeResult& e) { return e.distance_m; }));
  }
  return text;
}

std::string details_table(const std::vector<Row>& rows) {
  std::string text = fmt::format("{:<14}{:<12}{:<13}{:<15}{:<13}{}\n", "collisions", "rear-ended",
                                 "rear-ending", "side by other", "side by ego", "total");
  for (const Row& row : rows) {
    const auto& kinds = row.collisions_by_kind;
    text += fmt::format("{:<14}{:<12}{:<13}{:<15}{:<13}{}\n", row.planner, kinds[0], kinds[1],
                        kinds[2], kinds[3], row.collisions());
  }
  text += fmt::format("\n{:<14}{:<10}{:<16}{:<18}{:<20}{}\n", "distance", "km", "collisions/km",
                      "lane changes/km", "hard brakes/1000", "lanes % (right first)");
  for (const Row& row : rows) {
    const double lane_changes =
        row.sum([](const EpisodeResult& e) { return static_cast<double>(e.lane_changes); });
    const double hard_brakes =
        row.sum([](const EpisodeResult& e) { return static_cast<double>(e.hard_brakes); });
    const double km = std::max(row.km(), 1e-9);
    text += fmt::format("{:<14}{:<10.1f}{:<16.4f}{:<18.3f}{:<20.1f}{}\n", row.planner, row.km(),
                        static_cast<double>(row.collisions()) / km, lane_changes / km,
                        1000.0 * hard_brakes / row.steps(), lane_shares(row));
  }
  return text;
}

constexpr const char* kPaperTable =
    "The paper's Table I, for comparison (its own traffic; one policy; 40,000 steps; no "
    "intervals):\n"
    "planner                     BP reward  collisions  lane changes  km/h\n"
    "hierarchical RL             699        2.125       25.0          43.21\n"
    "rule-based BP and MoP       627        3.525       73.0          44.24\n"
    "rule-based BP with DQN MoP  531        3.350       79.2          41.29\n"
    "SUMO driving the ego        511        1.625       88.3          41.78\n";

}  // namespace

EvaluationResult parse_evaluation(const json& json, const std::string& name) {
  EvaluationResult result;
  try {
    read(json.at("planner"), result.planner);
    read(json.at("seed"), result.seed);
    read(json.at("steps"), result.steps);
    read(json.at("episodes"), result.episodes);
    read(json.at("bp_reward_per_1000"), result.bp_reward_per_1000);
    read(json.at("collisions"), result.collisions);
    for (std::size_t kind = 0; kind < kCollisionKinds.size(); ++kind) {
      read(json.at("collisions_by_kind").at(kCollisionKinds[kind]),
           result.collisions_by_kind[kind]);
    }
    read(json.at("lane_changes"), result.lane_changes);
    read(json.at("mean_speed_kph"), result.mean_speed_kph);
    read(json.at("distance_km"), result.distance_km);
    for (const auto& entry : json.at("per_episode")) {
      result.per_episode.push_back(parse_episode(entry));
      if (result.per_episode.back().steps <= 0) throw Failure("an episode of no steps");
    }
  } catch (const std::exception& error) {
    throw Failure("{} is no evaluation: {}", name, error.what());
  }
  if (result.per_episode.empty()) throw Failure("{} is no evaluation: it has no episodes", name);
  return result;
}

nlohmann::ordered_json evaluation_json(const std::vector<EvaluationResult>& results) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const EvaluationResult& result : results) {
    nlohmann::ordered_json kinds = nlohmann::ordered_json::object();
    for (std::size_t kind = 0; kind < kCollisionKinds.size(); ++kind) {
      kinds[kCollisionKinds[kind]] = result.collisions_by_kind[kind];
    }
    list.push_back({{"planner", result.planner},
                    {"seed", result.seed},
                    {"steps", result.steps},
                    {"episodes", result.episodes},
                    {"bp_reward_per_1000", result.bp_reward_per_1000},
                    {"collisions", result.collisions},
                    {"collisions_by_kind", kinds},
                    {"lane_changes", result.lane_changes},
                    {"mean_speed_kph", result.mean_speed_kph},
                    {"distance_km", result.distance_km}});
  }
  return list;
}

std::string evaluation_table(const std::vector<EvaluationResult>& results, double step_s,
                             std::uint64_t seed) {
  const std::vector<Row> rows = rows_of(results);
  return fmt::format(
      "Sums per 1000 steps [95 % interval: collisions exact Poisson, the rest "
      "bootstrap over episodes]\n{}\n{}\n{}",
      sums_table(rows, step_s, seed), details_table(rows), kPaperTable);
}

}  // namespace corridor::cluster
