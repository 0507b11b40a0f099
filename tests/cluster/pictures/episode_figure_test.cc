// SPDX-License-Identifier: Apache-2.0
#include "cluster/pictures/episode_figure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/driven.h"

namespace corridor::cluster {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Not;
using testing_support::areas;
using testing_support::drawn;
using testing_support::driven_episode;
using testing_support::texts;

DrivenEpisode episode(std::size_t steps) { return {"rules+mop_1002_3", driven_episode(steps)}; }

TEST(EpisodeFigure, ShowsTheTypicalEpisodeOverTime) {
  const Canvas picture = picture_of({"rules", episode(101), std::nullopt});
  EXPECT_THAT(texts(picture), IsSupersetOf({"rules, a typical episode", "right lane", "left lane",
                                            "km/h", "time, s", "0", "10", "50", "90", "100"}));
  EXPECT_THAT(texts(picture), Not(Contains(HasSubstr("collision"))));
  std::vector<Line> curves = drawn<Line>(picture.shapes);
  std::erase_if(curves, [](const Line& line) { return line.points.size() != 101; });
  ASSERT_EQ(curves.size(), 2u) << "place across the road, and speed";
  EXPECT_EQ(curves[0].points.front().x, curves[1].points.front().x);
}

TEST(EpisodeFigure, ShowsTheLastInstantsBeforeACollisionFromAbove) {
  const Canvas picture = picture_of({"rules", std::nullopt, episode(8)});
  EXPECT_THAT(texts(picture), AllOf(IsSupersetOf({"rules, before a collision", "5 s before",
                                                  "1 s before", "collision", "BP: left"}),
                                    Not(Contains("6 s before"))));
  const auto roads = drawn<Inset>(picture.shapes);
  ASSERT_EQ(roads.size(), 6u);
  EXPECT_EQ(areas(picture, kEgo).size(), 6u);
  EXPECT_EQ(areas(picture, kHit).size(), 6u) << "who is hit stands out";
  EXPECT_LT(roads.back().at.y + roads.back().height, picture.height);
}

TEST(EpisodeFigure, HasAsManyInstantsAsTheEpisode) {
  EXPECT_EQ(drawn<Inset>(picture_of({"rules", std::nullopt, episode(2)}).shapes).size(), 2u);
}

TEST(EpisodeFigure, OfBothShowsOneBelowTheOther) {
  const Canvas typical = picture_of({"rules", episode(9), std::nullopt}),
               failed = picture_of({"rules", std::nullopt, episode(9)}),
               both = picture_of({"rules", episode(9), episode(9)});
  EXPECT_EQ(both.height, typical.height + failed.height);
}

TEST(EpisodeFigure, SaysWhatItShows) {
  const std::string caption = caption_of({"rules+mop", episode(1000), episode(30)});
  for (const char* part : {"rules+mop_1002_3", "BP reward 500", "7 lane changes", "rear ending"})
    EXPECT_THAT(caption, HasSubstr(part));
}

}  // namespace
}  // namespace corridor::cluster
