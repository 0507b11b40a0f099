// SPDX-License-Identifier: Apache-2.0
#include "proto/system/files.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <thread>

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

TEST_F(Files, FoldersAreMadeWithTheirParentsAndNamedWhereTheyCannotBe) {
  const fs::path folder = directory_.path() / "a" / "b";
  const char* const children[] = {"c", "d/e"};
  create_folders(folder, children);
  EXPECT_TRUE(fs::is_directory(folder / "c"));
  EXPECT_TRUE(fs::is_directory(folder / "d" / "e"));
  write_file(file_, "");
  EXPECT_THAT(failure_of([&] { create_folders(file_ / "below"); }), HasSubstr("cannot create"));
}

class NewFolders : public Files {
 protected:
  // One with `content` in a file.
  static bool publish(const fs::path& target, const std::string& content) {
    NewFolder folder(target);
    write_file(folder.path() / "file", content);
    write_file(folder.path() / "last", "");
    return folder.publish("last");
  }

  fs::path target_ = directory_.path() / "a" / "b";
};

TEST_F(NewFolders, GetTheirNameWholeOrNotAtAll) {
  {
    NewFolder folder(target_);
    write_file(folder.path() / "file", "");
    EXPECT_FALSE(fs::exists(target_));
  }
  EXPECT_THAT(names_in(target_.parent_path()), testing::IsEmpty()) << "not published: gone";
  EXPECT_TRUE(publish(target_ / "", "one"));
  EXPECT_THAT(names_in(target_.parent_path()), UnorderedElementsAre("b"));
  EXPECT_THAT(names_in(target_), UnorderedElementsAre("file", "last"));
}

TEST_F(NewFolders, LeaveAloneWhatSomebodyElseHasMade) {
  EXPECT_TRUE(publish(target_, "theirs"));
  EXPECT_FALSE(publish(target_, "ours"));
  EXPECT_EQ(read_file(target_ / "file"), "theirs");
  EXPECT_THAT(names_in(target_.parent_path()), UnorderedElementsAre("b"));
  write_file(file_, "theirs");
  EXPECT_FALSE(publish(file_, "ours"));
  EXPECT_EQ(read_file(file_), "theirs");
}

TEST_F(NewFolders, TakeAFolderThatIsEmptyAndKeepIt) {
  create_folders(target_);
  struct stat before {
  }, after{};
  ASSERT_EQ(stat(target_.c_str(), &before), 0);
  EXPECT_TRUE(publish(target_, "one"));
  ASSERT_EQ(stat(target_.c_str(), &after), 0);
  EXPECT_EQ(before.st_ino, after.st_ino) << "a shell may stand in it";
  EXPECT_THAT(names_in(target_), UnorderedElementsAre("file", "last"));
}

TEST_F(NewFolders, OfWhichOneComesFirst) {
  NewFolder one(target_), two(target_);
  write_file(one.path() / "file", "one");
  write_file(two.path() / "file", "two");
  EXPECT_TRUE(two.publish());
  EXPECT_FALSE(one.publish());
  EXPECT_EQ(read_file(target_ / "file"), "two");
}

using OutputFiles = Files;

TEST_F(OutputFiles, AreReplacedWholeAlsoWhereALinkLeadsToThem) {
  const fs::path link = directory_.path() / "link";
  fs::create_symlink("file", link);
  OutputFile(link).write("new");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(read_file(file_), "new") << "the link led nowhere yet";
  OutputFile(link).write("newer");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(read_file(file_), "newer");
}

TEST_F(OutputFiles, ThatArePipesAreWrittenThrough) {
  ASSERT_EQ(mkfifo(file_.c_str(), 0600), 0);
  std::string read;
  std::thread reader([&] { read = read_file(file_); });
  OutputFile(file_).write("all of it");
  reader.join();
  EXPECT_EQ(read, "all of it");
  EXPECT_TRUE(fs::is_fifo(file_));
}

TEST_F(OutputFiles, OfAShellsDescriptorsAreWrittenThrough) {
  const Descriptor open_for(open(file_.c_str(), O_RDWR | O_CREAT, 0600));
  ASSERT_EQ(write(open_for.get(), "before\n", 7), 7);
  OutputFile(fs::path("/dev/fd") / std::to_string(open_for.get())).write("after\n");
  EXPECT_EQ(read_file(file_), "before\nafter\n");
  EXPECT_TRUE(fs::is_symlink("/dev/fd/0"));
}

TEST_F(OutputFiles, ThatCannotBeWrittenAreRefusedBeforeTheWork) {
  EXPECT_THAT(failure_of([&] { OutputFile{directory_.path()}; }), HasSubstr("it is a directory"));
  EXPECT_THAT(failure_of([] { OutputFile{"/nowhere/file"}; }),
              AllOf(HasSubstr("/nowhere/file"), HasSubstr("No such file")));
  EXPECT_THAT(failure_of([] { OutputFile("/dev/full").write("x"); }), HasSubstr("No space left"));
}

TEST_F(Files, WithoutANameAreReadByTheirPathAndLeaveNothing) {
  fs::path path;
  {
    UnnamedFile file;
    file.append("one ");
    file.append("two");
    EXPECT_EQ(file.content(), "one two");
    EXPECT_EQ(read_file(file.path()), "one two");
    path = file.path();
  }
  EXPECT_FALSE(fs::exists(path));
}

TEST_F(Files, InAPlainlyNamedFolderAreThoseOfTheFolder) {
  const fs::path folder = directory_.path() / "lr=0.1,seed=2:${HOME} 50%d";
  create_folders(folder);
  const PlainlyNamedFolder plain(folder);
  EXPECT_EQ(plain.path().string().find_first_of(",:$% "), std::string::npos);
  std::ofstream(plain.path() / "file") << "found";
  EXPECT_EQ(read_file(folder / "file"), "found");
  EXPECT_THAT(failure_of([&] { PlainlyNamedFolder{folder / "no"}; }), HasSubstr("cannot open"));
}

}  // namespace
}  // namespace corridor
