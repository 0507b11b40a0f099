#include "cluster/results/hindsight_result.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/base/failure.h"
#include "proto/base/json.h"

namespace corridor::cluster {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

Json collision(const char* by_last_1, const char* by_last_2, const char* by_reacting) {
  return {{"by_last_actions", {by_last_1, by_last_2}}, {"by_reacting", by_reacting}};
}

Json report(const char* planner, int seed) {
  return {{"planner", planner},
          {"seed", seed},
          {"steps", 2000},
          {"actions", 2},
          {"collisions",
           {collision("avoidable", "avoidable", "unavoidable"),
            collision("unavoidable", "avoidable", "avoidable"),
            collision("unavoidable", "undecided", "undecided"),
            collision("unavoidable", "unavoidable", "unavoidable")}}};
}

TEST(HindsightResult, CountsTheVerdicts) {
  const HindsightResult result = parse_hindsight(report("rules", 7), "file");
  EXPECT_EQ(result, (HindsightResult{"rules", 7, 2000, 4, {1, 2}, 1, 2, 1}));
}

TEST(HindsightResult, RefusesWhatIsNoHindsightNamingTheFile) {
  const auto refused = [](const char* pointer, const Json& value) {
    Json changed = report("rules", 7);
    changed[Json::json_pointer(pointer)] = value;
    EXPECT_THAT([&] { parse_hindsight(changed, "a/file"); },
                ThrowsMessage<Failure>(HasSubstr("a/file is no hindsight")))
        << pointer;
  };
  refused("/planner", 3);
  refused("/steps", 0);
  refused("/steps", 1e87);
  refused("/actions", 0);
  refused("/actions", 1'000'000);
  refused("/actions", 3);
  refused("/collisions/0/by_reacting", "perhaps");
  refused("/collisions/0/by_last_actions", "avoidable");
  refused("/collisions/0/by_last_actions/1", nullptr);
  EXPECT_THROW(parse_hindsight(Json::array(), "file"), Failure);
}

TEST(HindsightTable, AddsUpThePlannersSeeds) {
  const Table table = hindsight_table({parse_hindsight(report("rules", 7), "a"),
                                       parse_hindsight(report("sumo", 7), "b"),
                                       parse_hindsight(report("rules", 8), "c")});
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
  Json none = report("sumo", 7);
  none["collisions"] = Json::array();
  const Table table = hindsight_table({parse_hindsight(none, "a")});
  EXPECT_EQ(table.rows[0][1].text, "0.00");
  EXPECT_EQ(table.rows[0][2].text, "-");
  EXPECT_EQ(table.rows[0][5].text, "0.00");
}

}  // namespace
}  // namespace corridor::cluster
