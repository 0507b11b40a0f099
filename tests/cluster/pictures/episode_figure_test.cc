#include "cluster/pictures/episode_figure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cluster/pictures/gnuplot.h"

namespace corridor::cluster {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

// At 10 m/s in the middle lane, one vehicle 20 m ahead and one out of the picture.
DrivenEpisode episode(std::size_t steps, std::optional<TracedCollision> collision = {}) {
  EpisodeTrace trace;
  trace.step_s = 1.0;
  trace.lanes = 3;
  trace.lane_width_m = 3.2;
  trace.speed_limit_mps = 13.89;
  trace.bp_reward = 500.0;
  trace.lane_changes = 7;
  trace.collision = std::move(collision);
  for (std::size_t i = 0; i < steps; ++i) {
    const double s_m = 10.0 * static_cast<double>(i);
    trace.steps.push_back(
        {{0, s_m, 4.8, 10.0, 5.0, 1.8},
         1,
         {{8, s_m + 20.0, 1.6, 12.5, 5.0, 1.8}, {9, s_m + 80.0, 1.6, 25.0, 5.0, 1.8}}});
  }
  return {"rules+mop_1002_3", trace};
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t number = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++number;
  return number;
}

TEST(EpisodeFigure, ShowsTheTypicalEpisodeOverTime) {
  const std::string script =
      gnuplot_script({"rules", episode(100), std::nullopt}, PictureFormat::kSvg);
  EXPECT_THAT(script, HasSubstr("\n99 4.8\n"));
  EXPECT_THAT(script, HasSubstr("\n99 36\n"));
  EXPECT_THAT(script, HasSubstr("set xrange [0:99]"));
  EXPECT_THAT(script, HasSubstr("'rules, a typical episode'"));
  EXPECT_THAT(script, Not(HasSubstr("collision")));
}

TEST(EpisodeFigure, ShowsTheLastInstantsBeforeACollisionFromAbove) {
  const std::string script = gnuplot_script(
      {"rules", std::nullopt, episode(30, TracedCollision{"rear_ending", 8})}, PictureFormat::kSvg);
  EXPECT_THAT(script, HasSubstr("'5 s before'"));
  EXPECT_THAT(script, HasSubstr("'1 s before'"));
  EXPECT_THAT(script, Not(HasSubstr("'6 s before'")));
  EXPECT_EQ(count(script, "'collision'"), 1u);
  EXPECT_EQ(count(script, "rectangle"), 12u) << "the ego and the near vehicle, six times";
  EXPECT_EQ(count(script, "fc rgb '#d55e00'"), 6u) << "who is hit stands out";
  EXPECT_EQ(count(script, "'BP: left'"), 6u);
  EXPECT_THAT(script, HasSubstr("from 15.000,0.700 to 20.000,2.500"));
  EXPECT_THAT(script, HasSubstr("'45' at"));
}

TEST(EpisodeFigure, HasAsManyInstantsAsTheEpisode) {
  const std::string script = gnuplot_script(
      {"rules", std::nullopt, episode(2, TracedCollision{"rear_ending", 8})}, PictureFormat::kSvg);
  EXPECT_EQ(count(script, " s before'"), 1u);
}

TEST(EpisodeFigure, IsDrawnInBothFormats) {
  const EpisodeFigure figure{"rules+mop", episode(1000),
                             episode(30, TracedCollision{"rear_ending", 8})};
  EXPECT_THAT(run_gnuplot(gnuplot_script(figure, PictureFormat::kSvg)),
              HasSubstr("rules+mop, before a collision"));
  EXPECT_THAT(run_gnuplot(gnuplot_script(figure, PictureFormat::kPng)), StartsWith("\x89PNG"));
}

TEST(EpisodeFigure, SaysWhatItShows) {
  const std::string caption =
      caption_of({"rules+mop", episode(1000), episode(30, TracedCollision{"side_by_other", 8})});
  for (const char* part : {"rules+mop_1002_3", "BP reward 500", "7 lane changes", "side by other"})
    EXPECT_THAT(caption, HasSubstr(part));
}

}  // namespace
}  // namespace corridor::cluster
