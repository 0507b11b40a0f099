// SPDX-License-Identifier: Apache-2.0
#include "proto/system/program.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "proto/base/failure.h"
#include "proto/system/log.h"
#include "proto/system/pulse.h"

// run_program changes the process's signals and logger, so each test runs it in a process of its
// own.
namespace corridor {
namespace {

using testing::ExitedWithCode;

[[noreturn]] void run(const std::function<int()>& body) {
  std::exit(run_program("corridor-test", body));
}

TEST(ProgramDeathTest, TheBodysStatusIsTheProcesss) {
  EXPECT_EXIT(run([] { return 7; }), ExitedWithCode(7), "^$");
}

TEST(ProgramDeathTest, AFailureIsOneLineAndStatus1) {
  EXPECT_EXIT(run([]() -> int { throw Failure("no road {}", 66); }), ExitedWithCode(1),
              "^corridor-test: error: no road 66\n$");
}

TEST(ProgramDeathTest, AnyOtherExceptionToo) {
  EXPECT_EXIT(run([]() -> int { throw std::out_of_range("at"); }), ExitedWithCode(1),
              "corridor-test: error: at");
  EXPECT_EXIT(run([]() -> int { throw 3; }), ExitedWithCode(1), "corridor-test: error: ");
}

TEST(ProgramDeathTest, SignalsAskToStopAndDoNotEndTheProcess) {
  for (const int signal : kStopSignals) {
    EXPECT_EXIT(run([signal] {
                  if (stop_requested()) return 1;
                  std::raise(signal);
                  std::raise(SIGPIPE);
                  return stop_requested() ? 0 : 2;
                }),
                ExitedWithCode(128 + signal), "");
  }
}

TEST(ProgramDeathTest, ASignalThatItWasStartedToIgnoreIsIgnored) {
  std::signal(SIGHUP, SIG_IGN);  // as nohup does
  EXPECT_EXIT(run([] {
                std::raise(SIGHUP);
                if (stop_requested() || !was_ignored(SIGHUP)) return 1;
                std::raise(SIGTERM);
                return stop_requested() ? 0 : 2;
              }),
              ExitedWithCode(128 + SIGTERM), "");
  std::signal(SIGHUP, SIG_DFL);
}

TEST(ProgramDeathTest, WhatIsStoppedHalfwaySaysSoInOneLine) {
  EXPECT_EXIT(run([]() -> int {
                throw_if_stopped();
                std::raise(SIGINT);
                throw_if_stopped();
                return 0;
              }),
              ExitedWithCode(128 + SIGINT),
              "^corridor-test: stopped by a signal \\(Interrupt\\)\n$");
}

TEST(ProgramDeathTest, OutputThatIsLostIsAFailure) {
  EXPECT_EXIT((std::freopen("/dev/full", "w", stdout), run([] {
                 std::puts("the table");
                 return 0;
               })),
              ExitedWithCode(1), "cannot write all of standard output: No space left on device");
}

TEST(ProgramDeathTest, AFailureIsOneLineWhateverNamesItSpeaksOf) {
  EXPECT_EXIT(run([]() -> int { throw Failure("no file a\nb"); }), ExitedWithCode(1),
              "^corridor-test: error: no file a.nb\n$");
}

TEST(ProgramDeathTest, NoFileOfOursGetsTheNumberOfAClosedStream) {
  EXPECT_EXIT((close(STDIN_FILENO), close(STDOUT_FILENO), run([] {
                 const int opened = open("/dev/null", O_RDONLY);
                 return opened > STDERR_FILENO ? 0 : 2;
               })),
              ExitedWithCode(0), "");
}

TEST(ProgramDeathTest, LogLinesHaveTimeNameLevelAndText) {
  EXPECT_EXIT(run([] {
                log_info("round {}", 3);
                return 0;
              }),
              ExitedWithCode(0), "^[0-9-]+ [0-9:.]+ corridor-test info round 3\n$");
}

TEST(ProgramDeathTest, ItsStarterSeesItsPulse) {
  Pulse pulse;
  EXPECT_EQ(pulse.beats(), 0u);
  const pid_t child = fork();
  if (child == 0) {
    const std::string text = pulse.environment();
    putenv(const_cast<char*>(text.c_str()));
    run([] {
      for (int i = 0; i < 10; ++i) stop_requested();
      return getenv("CORRIDOR_PULSE") == nullptr ? 0 : 2;
    });
  }
  int status = -1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(pulse.beats(), 10u);
  beat();
  EXPECT_EQ(pulse.beats(), 10u) << "of another process";
}

}  // namespace
}  // namespace corridor
