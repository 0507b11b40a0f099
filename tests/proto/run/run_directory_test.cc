// SPDX-License-Identifier: Apache-2.0
#include "proto/run/run_directory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/system/files.h"
#include "tests/support/failure_of.h"
#include "tests/support/temporary_directory.h"

namespace corridor {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

class Runs : public testing::Test {
 protected:
  RunDirectory create() const { return RunDirectory::create(root_); }

  testing_support::TemporaryDirectory directory_;
  fs::path root_ = directory_.path() / "runs" / "one";
};

TEST_F(Runs, AreCreatedOnceWithTheirFolders) {
  const RunDirectory run = create();
  for (const fs::path& file : {run.network(), run.log("learner"), run.metrics("actor-0"),
                               run.evaluation() / "x", run.episodes() / "x"}) {
    EXPECT_TRUE(fs::is_directory(file.parent_path())) << file;
  }
  EXPECT_EQ(run.log("learner"), root_ / "log" / "learner.log");
  EXPECT_EQ(run.metrics("actor-0"), root_ / "metrics" / "actor-0.jsonl");
  EXPECT_THAT(failure_of([&] { create(); }),
              AllOf(HasSubstr(root_.string()), HasSubstr("exists already")));
}

TEST_F(Runs, ThatCannotBeCreatedAreNamed) {
  EXPECT_THAT(failure_of([] { RunDirectory::create("/proc/nothing/run"); }),
              HasSubstr("cannot create /proc/nothing/run"));
}

TEST_F(Runs, NeedAConfigAndAManifestToBeOpened) {
  EXPECT_THAT(failure_of([&] { RunDirectory::open(root_); }), HasSubstr("config.toml is missing"));
  const RunDirectory run = create();
  write_file(run.config(), "");
  EXPECT_THAT(failure_of([&] { RunDirectory::open(root_); }),
              HasSubstr("manifest.json is missing"));
  write_file(run.manifest(), "{}");
  EXPECT_EQ(RunDirectory::open(root_).root(), root_);
}

// People look at what is installed where they may not write.
TEST_F(Runs, AreOpenedWithoutAChangeAndGetTheFoldersTheyLackWhenAsked) {
  const RunDirectory run = create();
  write_file(run.config(), "");
  write_file(run.manifest(), "{}");
  const fs::path logs = run.log("learner").parent_path();
  fs::remove(logs);
  const RunDirectory opened = RunDirectory::open(root_);
  EXPECT_FALSE(fs::exists(logs));
  opened.create_folders();
  EXPECT_TRUE(fs::is_directory(logs));
}

TEST_F(Runs, LeaveAloneWhatOthersWriteWhenTheyAreCleanedUp) {
  const RunDirectory run = create();
  const fs::path ours[] = {root_ / "config.toml.tmp-7", run.metrics("learner.tmp-7"),
                           run.checkpoints() / "7.partial" / "x"};
  const fs::path theirs[] = {run.episodes() / "a.json.tmp-7",
                             root_ / "scenarios" / ".x.tmp-7-0" / "x",
                             root_ / "drives" / "a.png.tmp-7", root_ / "report" / "x.partial"};
  for (const auto& file : ours) {
    create_folders(file.parent_path());
    write_file(file, "");
  }
  for (const auto& file : theirs) {
    create_folders(file.parent_path());
    write_file(file, "");
  }
  run.remove_leftovers();
  for (const auto& file : ours) EXPECT_FALSE(fs::exists(file)) << file;
  for (const auto& file : theirs) EXPECT_TRUE(fs::exists(file)) << file;
}

TEST_F(Runs, ThatAreNewAppearWhole) {
  NewRun first(root_), second(root_);
  write_file(first.directory().config(), "");
  write_file(first.directory().manifest(), "first");
  EXPECT_FALSE(fs::exists(root_));
  EXPECT_TRUE(first.publish());
  EXPECT_FALSE(second.publish());
  EXPECT_EQ(read_file(RunDirectory::open(root_).manifest()), "first");
  EXPECT_THAT(failure_of([&] { NewRun{root_}; }), HasSubstr("continue it with `corridor resume"));
}

}  // namespace
}  // namespace corridor
