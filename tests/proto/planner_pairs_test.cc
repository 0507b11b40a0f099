#include "proto/planner_pairs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/failure.h"

namespace corridor {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(PlannerPairs, AreFoundByName) {
  EXPECT_TRUE(planner_pair("hierarchical").learned_bp);
  EXPECT_FALSE(planner_pair("rules+mop").learned_bp);
  EXPECT_TRUE(planner_pair("rules+mop").learned_mop);
  EXPECT_TRUE(planner_pair("sumo").world_drives);
}

TEST(PlannerPairs, AnUnknownNameIsAnsweredWithTheKnownOnes) {
  EXPECT_THAT([] { planner_pair("human"); },
              ThrowsMessage<Failure>(HasSubstr("no planner 'human'; choose among hierarchical, "
                                               "rules, rules+mop, bp+rules, sumo")));
}

}  // namespace
}  // namespace corridor
