#include "cluster/pictures/frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/driven.h"

namespace corridor::cluster {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Not;
using testing_support::drawn;
using testing_support::driven_episode;
using testing_support::texts;

Clip clip() {
  Clip clip = clip_of(driven_episode(4), "clip <&>", 0.0, 3.0);
  clip.speed_changes_mps = {-1.0, 1.0};
  return clip;
}

TEST(Frame, SaysWhatThePlannersChoseBy) {
  const Clip driven = clip();
  const Canvas frame = Frames(driven).at(1.0);
  EXPECT_THAT(texts(frame), IsSupersetOf({"clip <&>", "1.0 s", "keep", "left", "right", "2.00",
                                          "0.50", "straight", "-1 m/s", "+1 m/s", "0.10", "0.60"}));
  EXPECT_THAT(texts(frame), Contains(HasSubstr("speed 36 km/h, set-point")));
  EXPECT_THAT(texts(frame), Contains("nobody ahead"));
}

TEST(Frame, SaysOnlyTheCommandWhereNoNetworkDecides) {
  Clip driven = clip();
  for (TracedStep& step : driven.trace.steps) step.decision->bp_values.clear();
  EXPECT_THAT(texts(Frames(driven).at(1.0)), Contains("asks for left"));
  for (TracedStep& step : driven.trace.steps) step.decision.reset();
  EXPECT_THAT(texts(Frames(driven).at(1.0)), Not(Contains(HasSubstr("asks for"))));
}

TEST(Frame, MeasuresTheGapToWhoIsInTheWay) {
  Clip driven = clip();
  for (TracedStep& step : driven.trace.steps) {
    step.others = {{7, 45.0, 5.0, 5.0, 5.0, 1.8, 0.0}};
    step.on_the_way.clear();
  }
  EXPECT_THAT(texts(Frames(driven).at(1.0)), Contains("gap to the leader 30 m"));
  EXPECT_THAT(texts(Frames(driven).at(1.0)), Contains(HasSubstr(", leader 18")));
}

TEST(Frame, IsOfOneSizeThatVideosCanHave) {
  const Clip driven = clip();
  const Frames frames(driven);
  for (const double time_s : {0.0, 1.3, 3.0}) {
    const Canvas frame = frames.at(time_s);
    EXPECT_EQ(frame.width, 1280);
    EXPECT_EQ(frame.height, frames.at(0.0).height);
    EXPECT_EQ(std::fmod(frame.height, 2.0), 0.0);
  }
}

TEST(Frame, IsTheSameOfTheSameInstantOnly) {
  const Clip driven = clip();
  const std::string picture = Frames(driven).at(1.3).png();
  EXPECT_EQ(Frames(driven).at(1.3).png(), picture);
  EXPECT_NE(Frames(driven).at(1.4).png(), picture);
}

TEST(Frame, OfAClipOfOneInstantIsDrawn) {
  const Clip one = clip_of(driven_episode(1), "one", 0.0, 0.0);
  EXPECT_THAT(texts(Frames(one).at(0.0)), Contains("one"));
}

}  // namespace
}  // namespace corridor::cluster
