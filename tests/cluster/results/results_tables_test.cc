// SPDX-License-Identifier: Apache-2.0
#include "cluster/results/results_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace corridor::cluster {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<Arm> arms() {
  Arm hierarchical;
  hierarchical.planner = "hierarchical";
  hierarchical.training_seeds = 5;
  hierarchical.evaluation_seeds = 3;
  hierarchical.steps = 600'000;
  hierarchical.distance_km = 6549.6;
  hierarchical.collisions = 1234;
  hierarchical.lane_shares = {0.721, 0.25, 0.029};
  for (int quantity = 0; quantity <= static_cast<int>(Quantity::kBypassesPerKm); ++quantity)
    hierarchical.estimates[static_cast<Quantity>(quantity)] = {};
  Arm rules;
  rules.estimates = hierarchical.estimates;
  auto& estimates = hierarchical.estimates;
  estimates[Quantity::kBpReward] = {523.4, {506.2, 541.0}};
  estimates[Quantity::kCollisions] = {2.0567, {1.945, 2.175}};
  estimates[Quantity::kSpeed] = {39.31, {39.0, 39.6}};
  estimates[Quantity::kSideByOther] = {1.5, {1.25, 1.75}};
  estimates[Quantity::kCollisionsPerKm] = {0.18841, {0.178, 0.1992}};
  hierarchical.to_rules = Ratios{Estimate{1.214, {1.1, 1.3}}, std::nullopt};
  rules.planner = "rules";
  rules.evaluation_seeds = 3;
  return {hierarchical, rules};
}

std::vector<std::string> row_of(const Table& table, std::size_t row) {
  std::vector<std::string> texts;
  for (const Cell& cell : table.rows.at(row)) {
    texts.push_back(cell.text + (cell.interval.empty() ? "" : " " + cell.interval));
  }
  return texts;
}

TEST(ResultsTables, GiveEachArmARowOfEstimatesWithIntervals) {
  const std::vector<Table> tables = results_tables(arms());
  ASSERT_EQ(tables.size(), 4u);
  EXPECT_THAT(row_of(tables[0], 0),
              ElementsAre("hierarchical", "523 [506, 541]", "2.06 [1.95, 2.17]", "0.0 [0.0, 0.0]",
                          "39.3 [39.0, 39.6]", "0.0 [0.0, 0.0]"));
  EXPECT_THAT(tables[0].note, HasSubstr("interquartile mean over training seeds"));
  EXPECT_THAT(row_of(tables[1], 0),
              ElementsAre("hierarchical", "1,234", "0.00 [0.00, 0.00]", "0.00 [0.00, 0.00]",
                          "1.50 [1.25, 1.75]", "0.00 [0.00, 0.00]"));
  EXPECT_THAT(row_of(tables[2], 0),
              ElementsAre("hierarchical", "6550", "0.188 [0.178, 0.199]", "0.00 [0.00, 0.00]",
                          "0.00 [0.00, 0.00]", "72 / 25 / 3", "5", "3"));
  EXPECT_EQ(row_of(tables[2], 1)[6], "-") << "nothing is learned";
}

TEST(ResultsTables, PutThePapersRatiosBesideOurs) {
  const Table to_rules = results_tables(arms())[3];
  EXPECT_EQ(to_rules.title, "Ratios to rules");
  EXPECT_THAT(row_of(to_rules, 0),
              ElementsAre("hierarchical", "1.21 [1.10, 1.30]", "-", "-", "-", "-"));
  EXPECT_THAT(row_of(to_rules, 1),
              ElementsAre("the paper's hierarchical RL", "1.11", "0.60", "0.34", "0.98", "-"));

  std::vector<Arm> with_sumo = arms();
  with_sumo[0].to_sumo = Ratios{Estimate{1.06, {1.0, 1.1}}};
  EXPECT_EQ(row_of(results_tables(with_sumo)[4], 1)[1], "1.37");
}

TEST(ResultsTables, SayThatOneTrainingSeedIsOne) {
  std::vector<Arm> one = arms();
  one[0].training_seeds = 1;
  EXPECT_THAT(results_tables(one)[0].note, HasSubstr("nothing about another training seed"));
}

TEST(PaperTable, IsThePapersTableI) {
  const Table table = paper_table();
  ASSERT_EQ(table.rows.size(), 4u);
  EXPECT_THAT(row_of(table, 0), ElementsAre("hierarchical RL", "699", "2.125", "25.0", "43.21"));
  EXPECT_THAT(row_of(table, 3),
              ElementsAre("SUMO controlling the ego", "511", "1.625", "88.3", "41.78"));
}

HindsightRecord record(const char* planner, std::uint64_t seed) {
  const auto collision = [](Verdict by_last_1, Verdict by_last_2, Verdict by_reacting) {
    CollisionHindsight hindsight;
    hindsight.by_last_actions = {by_last_1, by_last_2};
    hindsight.by_reacting = by_reacting;
    return hindsight;
  };
  using enum Verdict;
  return {planner,
          seed,
          2000,
          {.actions = 2},
          {collision(kAvoidable, kAvoidable, kUnavoidable),
           collision(kUnavoidable, kAvoidable, kAvoidable),
           collision(kUnavoidable, kUndecided, kUndecided),
           collision(kUnavoidable, kUnavoidable, kUnavoidable)}};
}

TEST(HindsightTable, AddsUpThePlannersSeeds) {
  const Table table = hindsight_table({record("rules", 7), record("sumo", 7), record("rules", 8)});
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.columns.size(), table.rows[0].size());
  EXPECT_EQ(table.rows[0][0].text, "rules");
  EXPECT_EQ(table.rows[0][1].text, "2.00");  // 8 in 4000 steps
  EXPECT_EQ(table.rows[0][2].text, "25.0");
  EXPECT_EQ(table.rows[0][3].text, "50.0");
  EXPECT_EQ(table.rows[0][4].text, "25.0");
  EXPECT_EQ(table.rows[0][5].text, "1.00");
  // Garwood's interval of 4 is [1.0899, 10.2416].
  EXPECT_EQ(table.rows[0][5].interval, "[0.27, 2.56]");
  EXPECT_EQ(table.rows[0][6].text, "2");
  EXPECT_EQ(table.rows[1][0].text, "sumo");
  EXPECT_EQ(table.rows[1][6].text, "1");
}

TEST(HindsightTable, WithoutCollisionsThereAreNoShares) {
  HindsightRecord none = record("sumo", 7);
  none.collisions.clear();
  const Table table = hindsight_table({none});
  EXPECT_EQ(table.rows[0][1].text, "0.00");
  EXPECT_EQ(table.rows[0][2].text, "-");
  EXPECT_EQ(table.rows[0][5].text, "0.00");
}

TEST(WorldText, SaysInWhichTrafficAndAtWhichStep) {
  RunConfig config;
  config.traffic.blind_rate_per_s = 0.01;
  EXPECT_THAT(
      world_text(config),
      testing::AllOf(testing::HasSubstr(" vehicles within "),
                     testing::HasSubstr("0.01 a second move into its lane without looking"),
                     testing::HasSubstr("A step is 1 s, collisions are looked for every 1 s.")));
  config.traffic.blind_rate_per_s = 0.0;
  config.traffic.objects_per_km = 4.0;
  config.simulation.substeps = 5;
  config.dynamics.world = WorldKind::kSlip;
  EXPECT_THAT(world_text(config), testing::AllOf(testing::HasSubstr("all of them look"),
                                                 testing::HasSubstr("4 objects per km"),
                                                 testing::HasSubstr("dynamics.world = \"slip\""),
                                                 testing::HasSubstr("every 0.2 s")));
}

}  // namespace
}  // namespace corridor::cluster
