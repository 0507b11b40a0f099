// SPDX-License-Identifier: Apache-2.0
#include "cluster/watch/display.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <cstdlib>
#include <memory>

#include "proto/system/files.h"
#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

TEST(Display, InAFileLinesFollowEachOtherEveryTenSeconds) {
  testing_support::TemporaryDirectory temporary;
  const auto path = temporary.path() / "out";
  {
    const File out(std::fopen(path.c_str(), "w"), std::fclose);
    ProgressDisplay display(out.get());
    display.show({"one", "two"}, 100.0);
    display.show({"too early"}, 109.9);
    display.announce("stays");
    display.show({"three"}, 110.0);
  }
  EXPECT_EQ(read_file(path), "one\ntwo\nstays\nthree\n");
}

TEST(Display, OnATerminalThatKnowsNoControlSequencesLinesFollowEachOther) {
  const int master = posix_openpt(O_RDWR | O_NOCTTY);
  ASSERT_GE(master, 0);
  ASSERT_EQ(grantpt(master), 0);
  ASSERT_EQ(unlockpt(master), 0);
  const File out(std::fopen(ptsname(master), "w"), std::fclose);
  ASSERT_TRUE(out);
  setenv("TERM", "dumb", 1);
  {
    ProgressDisplay display(out.get());
    display.show({"one"}, 100.0);
    display.show({"two"}, 111.0);
  }
  unsetenv("TERM");
  char text[100];
  const ssize_t count = read(master, text, sizeof text);
  EXPECT_EQ(std::string(text, static_cast<std::size_t>(count)), "one\r\ntwo\r\n");
  close(master);
}

TEST(Display, WhereNothingCanBeWrittenNothingIsThrown) {
  const File out(std::fopen("/dev/full", "w"), std::fclose);
  ProgressDisplay display(out.get());
  EXPECT_NO_THROW(display.show({"one"}, 100.0));
  EXPECT_NO_THROW(display.announce("two"));
  EXPECT_NE(std::ferror(out.get()), 0);
}

// A pseudo terminal of 10 columns: what is written to it comes out at its other end.
TEST(Display, OnATerminalLinesAreWrittenOverAgainAndNoneWraps) {
  const int master = posix_openpt(O_RDWR | O_NOCTTY);
  ASSERT_GE(master, 0);
  ASSERT_EQ(grantpt(master), 0);
  ASSERT_EQ(unlockpt(master), 0);
  File out(std::fopen(ptsname(master), "w"), std::fclose);
  ASSERT_TRUE(out);
  termios settings;
  ASSERT_EQ(tcgetattr(fileno(out.get()), &settings), 0);
  settings.c_oflag &= ~static_cast<tcflag_t>(OPOST);  // "\n" comes out as it is
  ASSERT_EQ(tcsetattr(fileno(out.get()), TCSANOW, &settings), 0);
  const winsize size{25, 10, 0, 0};
  ASSERT_EQ(ioctl(master, TIOCSWINSZ, &size), 0);

  setenv("TERM", "xterm", 1);
  {
    ProgressDisplay display(out.get());
    display.show({"one", "longer than ten"}, 0.0);
    display.show({"three"}, 0.1);
    display.announce("stays");
    display.show({"four"}, 0.2);
  }
  out.reset();
  std::string written;
  char text[200];
  for (ssize_t length; (length = read(master, text, sizeof text)) > 0;)
    written.append(text, static_cast<std::size_t>(length));
  EXPECT_EQ(written,
            "one\nlonger th\n"
            "\x1b[2F\x1b[Jthree\n"
            "\x1b[1F\x1b[Jstays\nfour\n");
  close(master);
}

TEST(ProgressLine, FillsFromTheLeftAndNeverOverflows) {
  EXPECT_EQ(progress_line("", 0, 4000, "steps", 0.0),
            "[....................]   0.0 %  0 of 4,000 steps");
  EXPECT_EQ(progress_line("BP  ", 1000, 4000, "steps", 500.0),
            "BP  [#####...............]  25.0 %  1,000 of 4,000 steps  500 steps/s  6 s left");
  EXPECT_EQ(progress_line("", 17, 10, "cars", 0.0),
            "[####################] 170.0 %  17 of 10 cars");
}

}  // namespace
}  // namespace corridor::cluster
