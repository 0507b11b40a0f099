#include "proto/planner_pairs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/failure.h"

namespace corridor {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(PlannerPairs, AreFoundByName) {
  EXPECT_EQ(planner_pair("hierarchical").bp, BpKind::kLearned);
  EXPECT_EQ(planner_pair("rules+mop").bp, BpKind::kRules);
  EXPECT_EQ(planner_pair("rules+mop").mop, MopKind::kLearned);
  EXPECT_TRUE(planner_pair("sumo").world_drives());
  EXPECT_FALSE(planner_pair("left+rules").world_drives());
}

TEST(PlannerPairs, ThePapersRowsAreEvaluatedByDefaultAndTheNaiveOnesOnRequest) {
  for (const PlannerPair& pair : kPlannerPairs) {
    const bool naive = pair.bp == BpKind::kAlwaysKeep || pair.bp == BpKind::kAlwaysLeft ||
                       pair.bp == BpKind::kAlwaysRight;
    EXPECT_EQ(pair.by_default, !naive) << pair.name;
  }
}

TEST(PlannerPairs, AnUnknownNameIsAnsweredWithTheKnownOnes) {
  EXPECT_THAT([] { planner_pair("human"); },
              ThrowsMessage<Failure>(HasSubstr("no planner 'human'; choose among hierarchical, "
                                               "rules, rules+mop, bp+rules, sumo")));
}

}  // namespace
}  // namespace corridor
