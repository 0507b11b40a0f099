// SPDX-License-Identifier: Apache-2.0
#include "proto/run/checkpoints.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "proto/run/run_directory.h"
#include "proto/system/files.h"
#include "tests/support/failure_of.h"
#include "tests/support/temporary_directory.h"

namespace corridor {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;
using testing_support::names_in;

// Without write_file's cost; removed first, since some file systems flush what is overwritten.
void damage(const fs::path& file, const std::string& content) {
  fs::remove(file);
  std::ofstream(file, std::ios::binary) << content;
}

class CheckpointsTest : public testing::Test {
 protected:
  // With a file of its own, and one that all of them share.
  void add(std::uint64_t round, int kept = 2) const {
    const std::optional<fs::path> before = checkpoints_.newest();
    const fs::path partial = checkpoints_.begin(round);
    write_file(partial / "own", "of " + std::to_string(round));
    if (before) {
      fs::create_hard_link(*before / "shared", partial / "shared");
    } else {
      write_file(partial / "shared", "of all");
    }
    checkpoints_.commit(round, kept);
  }
  fs::path of(std::uint64_t round) const { return directory_.path() / std::to_string(round); }

  testing_support::TemporaryDirectory directory_;
  Checkpoints checkpoints_{directory_.path()};
};

TEST_F(CheckpointsTest, ThereIsNoneAtFirst) {
  EXPECT_EQ(checkpoints_.newest(), std::nullopt);
  EXPECT_THAT(checkpoints_.set_aside_damaged(), IsEmpty());
  EXPECT_EQ(Checkpoints("/nowhere/at/all").newest(), std::nullopt);
  EXPECT_THAT(failure_of([] { Checkpoints("/proc/self/status").newest(); }),
              HasSubstr("/proc/self/status"));
}

TEST_F(CheckpointsTest, WhatPeoplePutBesideThemStays) {
  for (const char* name : {"7.damaged", "8.partial", "best", "7.copy", "notes.txt"}) {
    fs::create_directory(directory_.path() / name);
  }
  add(9);
  EXPECT_THAT(names_in(directory_.path()),
              UnorderedElementsAre("9", "best", "7.copy", "notes.txt"));
}

TEST_F(CheckpointsTest, TheLargestRoundIsTheNewestAndOldOnesAreRemoved) {
  for (const std::uint64_t round : {7, 9, 10, 100}) add(round);
  EXPECT_EQ(checkpoints_.newest(), of(100));
  EXPECT_EQ(checkpoint_round(of(100)), 100u);
  EXPECT_THAT(names_in(directory_.path()), UnorderedElementsAre("10", "100"));
  EXPECT_EQ(read_file(of(100) / "shared"), "of all");
  EXPECT_NO_THROW(Checkpoints::check(of(100)));
  EXPECT_NO_THROW(Checkpoints::check(of(10)));
}

TEST_F(CheckpointsTest, OneThatWasNotCommittedDoesNotCount) {
  add(7);
  write_file(checkpoints_.begin(9) / "own", "half");
  EXPECT_EQ(checkpoints_.newest(), of(7));
  EXPECT_THAT(names_in(checkpoints_.begin(9)), IsEmpty());
  add(11);
  EXPECT_THAT(names_in(directory_.path()), UnorderedElementsAre("7", "11"));
}

TEST_F(CheckpointsTest, DamageIsNamedAndTheOneBeforeIsUsed) {
  for (const char* name : {"own", "manifest.json"}) {
    for (int kind = 0; kind < 3; ++kind) {
      add(7);
      add(9);
      const fs::path file = of(9) / name;
      std::string content = read_file(file);
      fs::remove(file);
      if (kind == 0) damage(file, content.substr(0, content.size() / 2));
      content[content.size() / 2] ^= 1;
      if (kind == 1) damage(file, content);
      EXPECT_THAT(failure_of([&] { Checkpoints::check(of(9)); }), HasSubstr(file.string()));
      EXPECT_THAT(checkpoints_.set_aside_damaged(), ElementsAre(HasSubstr(file.string())));
      EXPECT_EQ(checkpoints_.newest(), of(7));
      EXPECT_THAT(names_in(directory_.path()), UnorderedElementsAre("7", "9.damaged"));
      add(8);
      EXPECT_THAT(names_in(directory_.path()), UnorderedElementsAre("7", "8"));
    }
  }
}

TEST_F(CheckpointsTest, WhenAllAreDamagedThatIsAFailure) {
  for (const std::uint64_t round : {7, 9}) add(round);
  // They are one file.
  std::ofstream(of(9) / "shared") << "other";
  EXPECT_THAT(failure_of([&] { checkpoints_.set_aside_damaged(); }),
              AllOf(HasSubstr("no checkpoint"), HasSubstr((of(9) / "shared").string())));
  EXPECT_THAT(names_in(directory_.path()), UnorderedElementsAre("7", "9"));
}

TEST_F(CheckpointsTest, EveryTruncationAndEveryFlippedBitOfAFileIsNoticed) {
  add(7);
  const fs::path file = of(7) / "own";
  const std::string content = read_file(file);
  const auto expect_named = [&] {
    EXPECT_THAT(failure_of([&] { Checkpoints::check(of(7)); }), HasSubstr(file.string()));
    EXPECT_THAT(failure_of([&] { read_checkpoint_file(of(7), "own"); }), HasSubstr(file.string()));
  };
  for (std::size_t size = 0; size < content.size(); ++size) {
    damage(file, content.substr(0, size));
    expect_named();
    std::string flipped = content;
    flipped[size] ^= 1;
    damage(file, flipped);
    expect_named();
  }
  fs::remove(file);
  expect_named();
}

TEST_F(CheckpointsTest, ADamagedManifestIsNamed) {
  add(7);
  const fs::path manifest = of(7) / "manifest.json";
  const std::string content = read_file(manifest);
  for (std::size_t size = 0; size + 2 < content.size(); ++size) {  // "}\n"
    damage(manifest, content.substr(0, size));
    EXPECT_THAT(failure_of([&] { Checkpoints::check(of(7)); }), HasSubstr("manifest.json"));
  }
  for (std::size_t i = 0; i < content.size(); ++i) {
    std::string flipped = content;
    flipped[i] ^= 2;
    if (std::isspace(content[i]) && std::isspace(flipped[i])) continue;
    damage(manifest, flipped);
    EXPECT_THAT(failure_of([&] { Checkpoints::check(of(7)); }), HasSubstr(of(7).string())) << i;
  }
  fs::remove(manifest);
  EXPECT_THAT(failure_of([&] { Checkpoints::check(of(7)); }), HasSubstr("manifest.json"));
}

TEST(RowsFiles, AreFoundByTheirNamesAndMustFollowEachOther) {
  const testing_support::TemporaryDirectory directory;
  const auto touch = [&](const std::string& name) { std::ofstream(directory.path() / name); };
  for (const char* name :
       {"rows-12-30", "rows-3-5", "rows-5-12", "rows-x", "rows-1-2.tmp", "other"}) {
    touch(name);
  }
  EXPECT_THAT(rows_files(directory.path()),
              ElementsAre(RowsFile{3, 5}, RowsFile{5, 12}, RowsFile{12, 30}));
  EXPECT_EQ((RowsFile{3, 5}).name(), "rows-3-5");
  fs::remove(directory.path() / "rows-5-12");
  EXPECT_THAT(failure_of([&] { rows_files(directory.path()); }), HasSubstr("rows-12-30"));
  touch("rows-5-12");
  touch("rows-30-30");
  EXPECT_THAT(failure_of([&] { rows_files(directory.path()); }), HasSubstr("rows-30-30"));
}

}  // namespace
}  // namespace corridor
