// SPDX-License-Identifier: Apache-2.0
#include "cluster/pictures/film.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "proto/base/failure.h"
#include "proto/system/subprocess.h"
#include "tests/support/driven.h"
#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Not;
using testing::ThrowsMessage;
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

class Film : public testing::Test {
 protected:
  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(temporary_.path()), fs::directory_iterator()));
  }
  static void write_short(const fs::path& file) {
    write_film({clip_of(driven_episode(1), "short", 0.0, 0.0)}, file, [](double) {});
  }

  testing_support::TemporaryDirectory temporary_;
};

TEST_F(Film, HasTenFramesForEachSecondOfItsClips) {
  const fs::path film = temporary_.path() / "film.mp4";
  const Clip clip = clip_of(driven_episode(3), "clip", 0.0, 2.0);
  double last = 0.0;
  write_film({clip, clip}, film, [&](double share) {
    EXPECT_GE(share, last);
    EXPECT_LE(share, 1.0);
    last = share;
  });
  EXPECT_EQ(last, 1.0);
  const auto probe = run_subprocess(
      *find_program("ffprobe"),
      {"-v", "error", "-count_frames", "-show_entries",
       "stream=codec_name,width,height,nb_read_frames", "-of", "csv=p=0", film.string()},
      "", std::chrono::seconds(20));
  ASSERT_TRUE(probe);
  EXPECT_EQ(probe->output, "h264,1280,394,42\n");
  EXPECT_EQ(files(), 1u) << "the frames are gone";
}

TEST_F(Film, ThatCannotBeWrittenIsNamedAndLeavesNothing) {
  EXPECT_THAT([&] { write_short("/nowhere/film.mp4"); },
              ThrowsMessage<Failure>(HasSubstr("/nowhere/film.mp4")));
  EXPECT_EQ(files(), 0u);
}

TEST_F(Film, SaysThatItNeedsFfmpeg) {
  const std::string path = getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  EXPECT_THAT([&] { write_short(temporary_.path() / "film.mp4"); },
              ThrowsMessage<Failure>(HasSubstr("ffmpeg is not installed")));
  setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(files(), 0u);
}

}  // namespace
}  // namespace corridor::cluster
