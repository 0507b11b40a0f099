#include "cluster/pictures/clip.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "cluster/pictures/film.h"
#include "cluster/pictures/player.h"
#include "proto/base/failure.h"
#include "proto/system/subprocess.h"
#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;
using testing_support::TemporaryDirectory;

// At 10 m/s, two substeps a second; vehicle 8 is there from the second 2 on, 9 always.
EpisodeTrace trace(std::size_t steps) {
  EpisodeTrace trace;
  trace.step_s = 1.0;
  trace.lanes = 3;
  trace.lane_width_m = 3.2;
  trace.speed_limit_mps = 13.89;
  trace.collision = {"rear_ending", 9};
  for (std::size_t i = 0; i < steps; ++i) {
    const double s_m = 10.0 * static_cast<double>(i);
    TracedStep step;
    step.ego = {0, s_m, 4.8, 10.0, 5.0, 1.8, 0.0};
    step.command = 1;
    if (i >= 2) step.others.push_back({8, s_m + 20.0, 1.6, 12.5, 5.0, 1.8, 0.0});
    step.others.push_back({9, 60.0, 8.0, 0.0, 5.0, 1.8, 0.0});
    TracedDecision decision;
    decision.corridor = 8;
    decision.mop_action = 4;
    decision.bp_values = {1.0, 2.0, 0.5};
    decision.mop_values = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
    decision.window_first = 5;
    decision.window_open = {false, true, true, true, false};
    decision.front_gaps_m.assign(15, 40.0);
    decision.back_gaps_m.assign(15, 20.0);
    decision.path_s_m = {s_m, s_m + 10.0, s_m + 20.0};
    decision.path_d_m = {4.8, 5.2, 5.4};
    step.decision = decision;
    TracedScene half{{0, s_m + 4.0, 5.0, 11.0, 5.0, 1.8, 0.1}, step.others};
    step.on_the_way.push_back(half);
    trace.steps.push_back(step);
  }
  return trace;
}

TEST(Clip, IsAStretchInWholeStepsAndKnowsTheCollisionOnlyAtItsEnd) {
  const Clip middle = clip_of(trace(7), "middle", 2.0, 4.0);
  EXPECT_EQ(middle.trace.steps.size(), 3u);
  EXPECT_EQ(middle.start_s, 2.0);
  EXPECT_EQ(middle.duration_s(), 2.0);
  EXPECT_FALSE(middle.trace.collision);
  const Clip end = clip_of(trace(7), "end", 4.0, 99.0);
  EXPECT_EQ(end.trace.steps.size(), 3u);
  EXPECT_TRUE(end.trace.collision);
  const Clip before = clip_of(trace(7), "before", -3.0, 2.0);
  EXPECT_EQ(before.start_s, 0.0);
  EXPECT_EQ(clip_of(trace(1), "one", 0.0, 9.0).duration_s(), 0.0);
}

TEST(Clip, PutsVehiclesBetweenSimulatedInstants) {
  const Clip clip = clip_of(trace(4), "clip", 0.0, 3.0);
  EXPECT_EQ(clip.scene_at(0.0).ego.s_m, 0.0);
  EXPECT_DOUBLE_EQ(clip.scene_at(0.25).ego.s_m, 2.0);
  EXPECT_DOUBLE_EQ(clip.scene_at(0.5).ego.s_m, 4.0);
  EXPECT_DOUBLE_EQ(clip.scene_at(0.5).ego.yaw_rad, 0.1);
  EXPECT_DOUBLE_EQ(clip.scene_at(0.75).ego.s_m, 7.0);
  EXPECT_DOUBLE_EQ(clip.scene_at(1.0).ego.s_m, 10.0);
  EXPECT_DOUBLE_EQ(clip.scene_at(99.0).ego.s_m, 30.0);
  EXPECT_EQ(clip.scene_at(1.5).others.size(), 1u) << "8 has not come yet";
  EXPECT_EQ(clip.scene_at(2.5).others.size(), 2u);
}

// A picture of one colour would be a few bytes.
TEST(Film, PicturesAndFilmsAreWritten) {
  TemporaryDirectory temporary;
  Clip clip = clip_of(trace(4), "clip <&>", 0.0, 3.0);
  clip.speed_changes_mps = {-1.0, 1.0};
  const fs::path frame = temporary.path() / "frame.png", sheet = temporary.path() / "sheet.png",
                 several = temporary.path() / "several.png", film = temporary.path() / "film.mp4";
  write_frame(clip, 1.3, frame);
  EXPECT_GT(fs::file_size(frame), 5'000u);
  write_contact_sheet({clip}, 1.0, sheet);
  EXPECT_GT(fs::file_size(sheet), fs::file_size(frame) / 2);
  write_contact_sheet({clip, clip}, 1.0, several);
  EXPECT_GT(fs::file_size(several), 5'000u);
  double last = 0.0;
  write_film({clip, clip}, film, [&](double share) {
    EXPECT_GE(share, last);
    EXPECT_LE(share, 1.0);
    last = share;
  });
  EXPECT_EQ(last, 1.0);
  // As long as it says.
  const auto probe = run_subprocess(*find_program("ffprobe"),
                                    {"-v", "error", "-count_frames", "-show_entries",
                                     "stream=nb_read_frames", "-of", "csv=p=0", film.string()},
                                    "", std::chrono::seconds(20));
  ASSERT_TRUE(probe);
  EXPECT_EQ(std::atoi(probe->output.c_str()), 62);
  EXPECT_EQ(std::distance(fs::directory_iterator(temporary.path()), fs::directory_iterator()), 4)
      << "frames are gone";
  EXPECT_THROW(write_frame(clip, 0.0, "/nowhere/frame.png"), Failure);
}

TEST(Film, TheSameClipGivesTheSamePicture) {
  TemporaryDirectory temporary;
  const Clip clip = clip_of(trace(4), "clip", 0.0, 3.0);
  const auto content = [](const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream out;
    out << in.rdbuf();
    return out.str();
  };
  write_frame(clip, 1.3, temporary.path() / "a.png");
  write_frame(clip, 1.3, temporary.path() / "b.png");
  write_frame(clip, 1.4, temporary.path() / "c.png");
  EXPECT_EQ(content(temporary.path() / "a.png"), content(temporary.path() / "b.png"));
  EXPECT_NE(content(temporary.path() / "a.png"), content(temporary.path() / "c.png"));
}

TEST(Player, IsOnePageThatNeedsNothingElse) {
  const Clip clip = clip_of(trace(4), "</script><b>title", 0.0, 3.0);
  const std::string page = player_page({clip, clip});
  EXPECT_THAT(page, Not(HasSubstr("</script><b>")));
  EXPECT_THAT(page, HasSubstr("\\u003c/script>"));
  EXPECT_THAT(page, HasSubstr("\"on_the_way\""));
  for (const char* elsewhere : {"http://", "https://", "src=", "@import"}) {
    EXPECT_THAT(page, Not(HasSubstr(elsewhere)));
  }
}

}  // namespace
}  // namespace corridor::cluster
