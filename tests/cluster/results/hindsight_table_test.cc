#include "cluster/results/hindsight_table.h"

#include <gtest/gtest.h>

namespace corridor::cluster {
namespace {

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

}  // namespace
}  // namespace corridor::cluster
