// SPDX-License-Identifier: Apache-2.0
#include "cluster/pictures/chart.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/driven.h"

namespace corridor::cluster {
namespace {

using testing::ElementsAre;
using testing::FieldsAre;
using testing_support::drawn;

constexpr Chart kChart{100, 10, 200, 50, 20.0, 5.0};

TEST(Chart, HasItsOriginAtTheLowerLeft) {
  EXPECT_THAT(kChart.at(0.0, 0.0), FieldsAre(100, 60));
  EXPECT_THAT(kChart.at(20.0, 5.0), FieldsAre(300, 10));
}

TEST(Chart, DrawsACurveUpToNowWithItsGaps) {
  Canvas canvas;
  kChart.curve(canvas, {0.0, 5.0, std::nullopt, std::nullopt, 5.0, 0.0, 0.0}, 1.0, 5.0,
               {{}, kHit, 3.0});
  const auto lines = drawn<Line>(canvas.shapes);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_THAT(lines[0].points, ElementsAre(FieldsAre(100, 60), FieldsAre(110, 10)));
  EXPECT_THAT(lines[1].points, ElementsAre(FieldsAre(140, 10), FieldsAre(150, 60)));
  EXPECT_EQ(lines[1].colour, kHit);
  EXPECT_EQ(lines[1].width, 3.0);
}

TEST(Chart, DrawsALevelFromEdgeToEdge) {
  Canvas canvas;
  kChart.level(canvas, 2.5, {{}, kLine, 1.0, 6.0});
  const auto lines = drawn<Line>(canvas.shapes);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_THAT(lines[0].points, ElementsAre(FieldsAre(100, 35), FieldsAre(300, 35)));
  EXPECT_EQ(lines[0].dash, 6.0);
}

}  // namespace
}  // namespace corridor::cluster
