// SPDX-License-Identifier: Apache-2.0
#include "actor/driving/fixed_bp.h"

#include <gtest/gtest.h>

#include "tests/actor/driving/scenes.h"

namespace corridor::driving {
namespace {

TEST(FixedBp, AsksForTheSameWhereThereIsALane) {
  const Lanes lanes(kSettings);
  FixedBp left(Command::kLeft, kSettings);
  FixedBp right(Command::kRight, kSettings);
  FixedBp keep(Command::kKeep, kSettings);
  for (int lane = 0; lane < lanes.lanes(); ++lane) {
    const Situation situation =
        situation_of({ego_at(lanes.lane_centre_m(lane), 10.0), {}}, kSettings);
    const bool leftmost = lane == lanes.lanes() - 1;
    EXPECT_EQ(left.decide(situation), leftmost ? Command::kKeep : Command::kLeft) << lane;
    EXPECT_EQ(right.decide(situation), lane == 0 ? Command::kKeep : Command::kRight) << lane;
    EXPECT_EQ(keep.decide(situation), Command::kKeep) << lane;
  }
}

}  // namespace
}  // namespace corridor::driving
