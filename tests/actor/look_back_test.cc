#include "actor/look_back.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/base/failure.h"
#include "proto/base/json.h"
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
    const Json episode = testing_support::record_collision(config_, world);
    std::filesystem::create_directories(run_.episodes());
    write_file(run_.episodes() / "rules_5_1.json", episode.dump());
    const Json totals = {
        {"steps", 1234},
        {"per_episode",
         {{{"episode", 0}, {"collisions", 0}}, {{"episode", 1}, {"collisions", 1}}}}};
    write_file(run_.evaluation() / "rules_5.json", totals.dump());
  }

  std::string report(bool go_on = true) {
    FakeWorld world(config_);
    report_hindsight(config_, {"rules", 5, {}}, run_, world, [&](std::size_t done, std::size_t of) {
      EXPECT_EQ(done, 1u);
      EXPECT_EQ(of, 1u);
      return go_on;
    });
    const auto file = run_.hindsight() / "rules_5.json";
    return std::filesystem::exists(file) ? read_file(file) : "";
  }

  testing_support::TemporaryDirectory temporary_;
  RunDirectory run_ = RunDirectory::create(temporary_.path() / "run");
  RunConfig config_;
};

TEST_F(HindsightReport, HasOneObjectACollisionWithTheDocumentedFields) {
  const Json written = Json::parse(report());
  EXPECT_EQ(written["planner"], "rules");
  EXPECT_EQ(written["seed"], 5);
  EXPECT_EQ(written["steps"], 1234);
  EXPECT_EQ(written["actions"], HindsightLimits{}.actions);
  EXPECT_EQ(written["attempts_max"], HindsightLimits{}.attempts_max);
  ASSERT_EQ(written["collisions"].size(), 1u);
  const Json& collision = written["collisions"][0];
  EXPECT_EQ(collision["episode"], 1);
  EXPECT_EQ(collision["collision_kind"], "rear_ending");
  EXPECT_EQ(collision["by_last_actions"].size(), 4u);
  EXPECT_EQ(collision["recorded"], Json({16, 16, 16, 16})) << "straight on, ever faster";
  EXPECT_EQ(collision["escape"].size(), collision["attempts"].size() + kMarginSteps);
  EXPECT_GT(collision["actions_in_sight"], 0);
  EXPECT_GT(collision["step"], 0);
  EXPECT_TRUE(collision["by_reacting"].is_string());
}

TEST_F(HindsightReport, TwiceWritesEqualFiles) {
  const std::string first = report();
  EXPECT_FALSE(first.empty());
  EXPECT_EQ(report(), first);
}

TEST_F(HindsightReport, StoppedWritesNothing) { EXPECT_EQ(report(false), ""); }

TEST_F(HindsightReport, RefusesWhatIsNoEvaluation) {
  write_file(run_.evaluation() / "rules_5.json", "{}");
  EXPECT_THAT([&] { report(); }, ThrowsMessage<Failure>(HasSubstr("is no evaluation")));
  std::filesystem::remove(run_.evaluation() / "rules_5.json");
  EXPECT_THROW(report(), Failure);
}

}  // namespace
}  // namespace corridor::actor
