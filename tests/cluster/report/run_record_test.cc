// SPDX-License-Identifier: Apache-2.0
#include "cluster/report/run_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "proto/base/failure.h"
#include "proto/run/run_directory.h"
#include "proto/system/files.h"
#include "tests/support/fake_run.h"
#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Key;
using testing::Not;
using testing::Pair;
using testing::SizeIs;
using testing::ThrowsMessage;
using testing_support::fake_run_config;
using testing_support::make_fake_run;

class Records : public testing::Test {
 protected:
  RunRecord record(const char* name, const RunConfig& config) {
    return read_run(make_fake_run(root(name), config).root());
  }
  std::filesystem::path root(const char* name) const { return temporary_.path() / name; }

  testing_support::TemporaryDirectory temporary_;
};

TEST_F(Records, HoldWhatTheDirectoryHolds) {
  const RunDirectory directory = make_fake_run(root("run"), fake_run_config(7));
  const auto dense = root("run") / "scenarios" / "dense";
  std::filesystem::create_directories(dense);
  std::filesystem::copy(directory.evaluation(), dense / "evaluation");
  std::filesystem::remove(dense / "evaluation" / "random+rules_1002.json");
  RunConfig dense_config = fake_run_config(7);
  dense_config.traffic.vehicles_max = 20;
  write_file(dense / "config.toml", to_toml(dense_config));
  const auto same = root("run") / "scenarios" / "same";
  std::filesystem::create_directories(same);
  std::filesystem::copy(directory.evaluation(), same / "evaluation");
  std::filesystem::copy(directory.config(), same / "config.toml");
  const RunRecord run = read_run(root("run"));
  EXPECT_EQ(run.config.run.seed, 7u);
  EXPECT_EQ(run.scenario, "fake");
  EXPECT_THAT(run.made_with, Contains(Pair("seed", "7")));
  EXPECT_THAT(run.made_with, Contains(Key("git_commit")));
  EXPECT_THAT(run.made_with, Not(Contains(Key("run_id")))) << "it lets one into a run";
  EXPECT_FALSE(run.fingerprint);
  ASSERT_THAT(run.actors, SizeIs(2));
  EXPECT_THAT(run.actors[1], SizeIs(10));
  EXPECT_THAT(run.learner, testing::ElementsAre(SizeIs(1)));
  EXPECT_THAT(run.evaluations, SizeIs(3));
  EXPECT_THAT(run.worlds_of_training, testing::ElementsAre("", "same"));
  EXPECT_THAT(run.evaluations.at(""), SizeIs(2));
  EXPECT_THAT(run.evaluations.at("dense"), SizeIs(1));
}

TEST_F(Records, OfWhatIsNoRunOrDamagedFailWithItsName) {
  EXPECT_THAT([&] { read_run(root("missing")); }, ThrowsMessage<Failure>(HasSubstr("missing")));
  const RunDirectory directory = make_fake_run(root("run"), fake_run_config(7));
  write_file(directory.evaluation() / "sumo_1002.json", "{}");
  EXPECT_THAT([&] { read_run(root("run")); }, ThrowsMessage<Failure>(HasSubstr("sumo_1002.json")));
  std::filesystem::remove(directory.evaluation() / "sumo_1002.json");
  std::ofstream(directory.metrics(kLearnerName), std::ios::app) << "{\"phase\":3}\n";
  EXPECT_THAT([&] { read_run(root("run")); }, ThrowsMessage<Failure>(HasSubstr("learner.jsonl:2")));
  std::filesystem::remove_all(root("run") / "metrics");
  EXPECT_THAT([&] { read_run(root("run")); }, ThrowsMessage<Failure>(HasSubstr("no metrics")));
  write_file(directory.manifest(), "[]");
  EXPECT_THAT([&] { read_run(root("run")); }, ThrowsMessage<Failure>(HasSubstr("manifest.json")));
}

TEST_F(Records, OfOneTrainingAreAGroupOrderedBySeed) {
  RunConfig other = fake_run_config(1), elsewhere = fake_run_config(3);
  other.dqn[0].gamma = 0.5;
  elsewhere.run.transport = Transport::kTcp;
  elsewhere.evaluation.steps = 5;
  const auto groups = grouped_runs({record("a", fake_run_config(2)), record("b", other),
                                    record("c", fake_run_config(1)), record("d", elsewhere)});
  ASSERT_THAT(groups, SizeIs(2));
  EXPECT_EQ(groups[0].label, "fake");
  ASSERT_THAT(groups[0].runs, SizeIs(3));
  EXPECT_EQ(groups[0].runs[0].root, root("c"));
  EXPECT_EQ(groups[0].runs[1].root, root("a"));
  EXPECT_EQ(groups[0].runs[2].root, root("d"));
  EXPECT_EQ(groups[1].label, "fake (2)");
}

TEST_F(Records, OfTheSameTrainingAndSeedAreNotAveraged) {
  const std::vector<RunRecord> runs = {record("a", fake_run_config(1)),
                                       record("b", fake_run_config(1))};
  EXPECT_THAT(
      [&] { grouped_runs(runs); },
      ThrowsMessage<Failure>(AllOf(HasSubstr("same seed, 1"), HasSubstr("/a"), HasSubstr("/b"))));
}

}  // namespace
}  // namespace corridor::cluster
