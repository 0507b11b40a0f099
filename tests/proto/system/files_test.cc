// SPDX-License-Identifier: Apache-2.0
#include "proto/system/files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "proto/base/json.h"
#include "tests/support/failure_of.h"
#include "tests/support/temporary_directory.h"

namespace corridor {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::UnorderedElementsAre;
using testing_support::names_in;

class Files : public testing::Test {
 protected:
  testing_support::TemporaryDirectory directory_;
  fs::path file_ = directory_.path() / "file";
};

TEST_F(Files, AreWrittenWholeAndReadBack) {
  const std::string content = std::string("a\0b\n", 4) + std::string(1'000'000, 'x');
  write_file(file_, content);
  EXPECT_EQ(read_file(file_), content);
  write_file(file_, "");
  EXPECT_EQ(read_file(file_), "");
  EXPECT_THAT(names_in(directory_.path()), UnorderedElementsAre("file"));
}

TEST_F(Files, ThatCannotBeWrittenAreNamedWithTheReason) {
  EXPECT_THAT(failure_of([] { write_file("/nowhere/at/all", "x"); }),
              AllOf(HasSubstr("/nowhere/at/all"), HasSubstr("No such file")));
  fs::create_directory(file_);
  write_file(file_ / "inside", "x");
  EXPECT_THAT(failure_of([&] { write_file(file_, "x"); }), HasSubstr("directory"));
  EXPECT_THAT(names_in(directory_.path()), UnorderedElementsAre("file"));
}

// Writes with a limit on file sizes, which fails in the middle of a file as a full disk does.
[[noreturn]] void write_beyond_the_limit(const fs::path& file) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{1000, 1000};
  setrlimit(RLIMIT_FSIZE, &limit);
  const std::string failure = failure_of([&] { write_file(file, std::string(5000, 'n')); });
  std::fprintf(stderr, "%s\n", failure.c_str());
  std::exit(failure == "no failure" ? 1 : 0);
}

TEST_F(Files, AFullDiskLeavesTheOldFileAndNothingBesideIt) {
  write_file(file_, "old");
  EXPECT_EXIT(write_beyond_the_limit(file_), testing::ExitedWithCode(0), "File too large");
  EXPECT_EQ(read_file(file_), "old");
  EXPECT_THAT(names_in(directory_.path()), UnorderedElementsAre("file"));
}

TEST_F(Files, ThatCannotBeReadAreNamedWithTheReason) {
  EXPECT_THAT(failure_of([&] { read_file(file_); }),
              AllOf(HasSubstr(file_.string()), HasSubstr("No such file")));
  EXPECT_THAT(failure_of([&] { read_file(directory_.path()); }), HasSubstr("Is a directory"));
}

TEST_F(Files, OfUnknownSizeAreReadToTheEnd) {
  EXPECT_THAT(read_file("/proc/self/status"), HasSubstr("VmRSS"));
}

TEST_F(Files, ThatAreNoJsonAreNamed) {
  write_file(file_, "{\"a\": 1}");
  EXPECT_EQ(read_json(file_).at("a"), 1);
  write_file(file_, "{\"a\": ");
  EXPECT_THAT(failure_of([&] { read_json(file_); }),
              AllOf(HasSubstr(file_.string()), HasSubstr("is not JSON")));
}

TEST_F(Files, FoldersInTheMakingGoUnlessTheyAreKept) {
  const fs::path folder = directory_.path() / "a" / "b";
  const char* const children[] = {"c", "d/e"};
  {
    create_folders(folder, children);
    const FolderInTheMaking made(folder);
    write_file(folder / "d" / "e" / "file", "");
  }
  EXPECT_FALSE(fs::exists(folder));
  EXPECT_TRUE(fs::exists(folder.parent_path()));
  {
    create_folders(folder);
    FolderInTheMaking made(folder);
    made.keep();
  }
  EXPECT_TRUE(fs::exists(folder));
  write_file(file_, "");
  EXPECT_THAT(failure_of([&] { create_folders(file_ / "below"); }), HasSubstr("cannot create"));
}

}  // namespace
}  // namespace corridor
