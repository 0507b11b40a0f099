// SPDX-License-Identifier: Apache-2.0
#include "proto/settings/planner_pairs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/base/failure.h"

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
  EXPECT_EQ(planner_pair("random+rules").bp, BpKind::kRandom);
  EXPECT_FALSE(planner_pair("hierarchical").shielded);
  EXPECT_TRUE(planner_pair("hierarchical+shield").shielded);
}

TEST(PlannerPairs, ThePapersRowsAreEvaluatedByDefaultAndTheOthersOnRequest) {
  for (const PlannerPair& pair : kPlannerPairs) {
    const bool of_the_paper =
        !pair.shielded &&
        (pair.bp == BpKind::kLearned || pair.bp == BpKind::kRules || pair.bp == BpKind::kNone);
    EXPECT_EQ(pair.by_default, of_the_paper) << pair.name;
  }
}

TEST(PlannerPairs, AreLearnedWhenEitherPlannerIs) {
  for (const char* name : {"hierarchical", "rules+mop", "bp+rules", "random+mop"}) {
    EXPECT_TRUE(planner_pair(name).learned()) << name;
  }
  for (const char* name : {"rules", "sumo", "left+rules", "random+rules"}) {
    EXPECT_FALSE(planner_pair(name).learned()) << name;
  }
}

TEST(PlannerPairs, AnUnknownNameIsAnsweredWithTheKnownOnes) {
  EXPECT_THAT([] { planner_pair("human"); },
              ThrowsMessage<Failure>(HasSubstr("no planner 'human'; choose among hierarchical, "
                                               "rules, rules+mop, bp+rules, sumo")));
}

}  // namespace
}  // namespace corridor
