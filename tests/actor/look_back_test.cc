#include "actor/look_back.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "actor/avoidance.h"
#include "proto/base/failure.h"
#include "proto/run/evaluation_record.h"
#include "proto/run/hindsight_record.h"
#include "proto/run/recorded_episode.h"
#include "proto/system/files.h"
#include "tests/support/fake_world.h"
#include "tests/support/recorded_collision.h"
#include "tests/support/temporary_directory.h"

namespace corridor::actor {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;
using testing_support::FakeWorld;

// An evaluation of two episodes, the second of which ends in a collision.
class HindsightReport : public testing::Test {
 protected:
  HindsightReport() {
    config_.simulation.episode_steps = 100;
    FakeWorld world(config_);
    const RecordedEpisode second = testing_support::record_collision(config_, world);
    write_recorded_episode(run_, second);
    EpisodeRecord first;
    first.steps = 1234;
    write_evaluation(run_, evaluation_of({"rules", 5}, 1.0, {first, second.summary}));
  }

  std::string report(bool go_on = true) {
    FakeWorld world(config_);
    report_hindsight(config_, {"rules", 5, {}}, run_, world,
                     [&](std::int64_t done, std::int64_t of) {
                       EXPECT_EQ(done, 1);
                       EXPECT_EQ(of, 1);
                       return go_on;
                     });
    const auto file = run_.hindsight({"rules", 5});
    return std::filesystem::exists(file) ? read_file(file) : "";
  }

  testing_support::TemporaryDirectory temporary_;
  RunDirectory run_ = RunDirectory::create(temporary_.path() / "run");
  RunConfig config_;
};

TEST_F(HindsightReport, HasARecordOfEveryCollision) {
  report();
  const HindsightRecord written = read_hindsight(run_.hindsight({"rules", 5}));
  EXPECT_EQ(written.planner, "rules");
  EXPECT_EQ(written.seed, 5u);
  EXPECT_EQ(written.limits, HindsightLimits{});
  ASSERT_EQ(written.collisions.size(), 1u);
  const CollisionHindsight& collision = written.collisions[0];
  EXPECT_EQ(written.steps, 1234 + collision.step);
  EXPECT_EQ(collision.episode, 1u);
  EXPECT_EQ(collision.collision_kind, CollisionKind::kRearEnding);
  EXPECT_EQ(collision.by_last_actions.size(), 4u);
  EXPECT_EQ(collision.recorded, (std::vector<int>{16, 16, 16, 16})) << "straight on, ever faster";
  EXPECT_EQ(collision.escape.size(), collision.attempts.size() + kMarginSteps);
  EXPECT_GT(collision.actions_in_sight, 0);
}

TEST_F(HindsightReport, TwiceWritesEqualFiles) {
  const std::string first = report();
  EXPECT_FALSE(first.empty());
  EXPECT_EQ(report(), first);
}

TEST_F(HindsightReport, StoppedWritesNothing) { EXPECT_EQ(report(false), ""); }

TEST_F(HindsightReport, RefusesWhatIsNoEvaluation) {
  write_file(run_.evaluation({"rules", 5}), "{}");
  EXPECT_THAT([&] { report(); }, ThrowsMessage<Failure>(HasSubstr("is no evaluation")));
  std::filesystem::remove(run_.evaluation({"rules", 5}));
  EXPECT_THROW(report(), Failure);
}

}  // namespace
}  // namespace corridor::actor
