#include "cluster/pictures/film.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "proto/base/failure.h"
#include "proto/system/subprocess.h"
#include "tests/support/driven.h"
#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::ThrowsMessage;
using testing_support::driven_episode;

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
  EXPECT_THAT([&] { write_short(temporary_.path() / "film.unknown"); },
              ThrowsMessage<Failure>(HasSubstr("ffmpeg cannot write")));
  EXPECT_EQ(files(), 0u);
}

TEST_F(Film, SaysThatItNeedsFfmpeg) {
  const std::string path = getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  EXPECT_THAT([&] { write_short(temporary_.path() / "film.mp4"); },
              ThrowsMessage<Failure>(HasSubstr("no ffmpeg")));
  setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(files(), 0u);
}

}  // namespace
}  // namespace corridor::cluster
