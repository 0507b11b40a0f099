// SPDX-License-Identifier: Apache-2.0
#include "proto/system/subprocess.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "proto/base/failure.h"
#include "proto/system/program.h"
#include "tests/support/temporary_directory.h"

namespace corridor {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr std::chrono::milliseconds kLong{20'000};

SubprocessResult shell(const std::string& script, const std::string& input = {}) {
  const auto result = run_subprocess("/bin/sh", {"-c", script}, input, kLong);
  EXPECT_TRUE(result.has_value()) << script;
  return result.value_or(SubprocessResult{});
}

TEST(Subprocess, KeepsOutputsApartAndSaysHowItEnded) {
  const SubprocessResult result = shell("echo one; echo two >&2; exit 3");
  EXPECT_EQ(result.status, 3);
  EXPECT_EQ(result.output, "one\n");
  EXPECT_EQ(result.errors, "two\n");
  EXPECT_EQ(shell("kill -9 $$").status, 128 + 9);
}

TEST(Subprocess, ReadsItsInputHoweverLargeWhileItWrites) {
  const std::string input(3'000'000, 'x');
  EXPECT_EQ(shell("cat; cat /dev/null >&2", input).output, input);
  EXPECT_EQ(shell("true", input).status, 0) << "one that does not read it";
}

TEST(Subprocess, OfWhichBothOutputsAreFullDoesNotHang) {
  const SubprocessResult result =
      shell("head -c 300000 /dev/zero >&2; head -c 300000 /dev/zero; head -c 300000 /dev/zero >&2");
  EXPECT_EQ(result.output.size(), 300'000u);
  EXPECT_EQ(result.errors.size(), 600'000u);
}

TEST(Subprocess, IsKilledAtTheDeadline) {
  // None is left: killed and reaped.
  EXPECT_EQ(run_subprocess("/bin/sleep", {"1000"}, "", std::chrono::milliseconds(0)), std::nullopt);
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
}

TEST(Subprocess, ThatClosesItsOutputsAndWorksOnIsWaitedFor) {
  // It opens the pipe with its outputs closed, and ends once it has read.
  testing_support::TemporaryDirectory temporary;
  const std::filesystem::path pipe = temporary.path() / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::thread opener([&] { std::ofstream(pipe) << "end\n"; });
  EXPECT_EQ(shell("exec >&- 2>&-; read line < " + pipe.string() + "; exit 4").status, 4);
  opener.join();
}

TEST(Subprocess, RunsInTheDirectoryThatItIsGiven) {
  testing_support::TemporaryDirectory temporary;
  const auto result = run_subprocess("/bin/sh", {"-c", "pwd -P"}, "", kLong, temporary.path());
  EXPECT_EQ(result->output, std::filesystem::canonical(temporary.path()).string() + "\n");
}

TEST(SubprocessDeathTest, EndsWithASignalToThisProcess) {
  EXPECT_EXIT(std::exit(run_program(
                  "test",
                  [] {
                    run_subprocess("/bin/sh", {"-c", "kill -INT $PPID; exec sleep 600"}, "", kLong);
                    return 0;
                  })),
              testing::ExitedWithCode(128 + SIGINT), "stopped by a signal");
}

TEST(Subprocess, ThatCannotBeStartedIsNamed) {
  EXPECT_THAT([] { run_subprocess("/nowhere/program", {}, "", kLong); },
              ThrowsMessage<Failure>(HasSubstr("cannot start /nowhere/program: No such file")));
}

TEST(FindProgram, LooksInTheFoldersGivenThenInPath) {
  testing_support::TemporaryDirectory temporary;
  const auto own = temporary.path() / "sh";
  std::filesystem::copy_file("/bin/sh", own);
  EXPECT_EQ(find_program("sh", {"/nowhere", temporary.path()}), own);
  EXPECT_NE(find_program("sh", {"/nowhere"}), std::nullopt);
  EXPECT_EQ(find_program("no-such-program"), std::nullopt);
}

}  // namespace
}  // namespace corridor
