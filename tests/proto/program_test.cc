#include "proto/program.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "proto/failure.h"

// run_program changes the process's signals and logger, so each test runs it in a process of its
// own.
namespace corridor {
namespace {

using testing::ExitedWithCode;

[[noreturn]] void run(const std::function<int()>& body) {
  std::exit(run_program("corridor-test", false, body));
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
  for (const int signal : {SIGTERM, SIGINT}) {
    EXPECT_EXIT(run([signal] {
                  if (stop_requested()) return 1;
                  std::raise(signal);
                  std::raise(SIGPIPE);
                  return stop_requested() ? 0 : 2;
                }),
                ExitedWithCode(0), "");
  }
}

TEST(ProgramDeathTest, LogLinesHaveTimeNameLevelAndText) {
  EXPECT_EXIT(run([] {
                spdlog::info("round {}", 3);
                return 0;
              }),
              ExitedWithCode(0), "^[0-9-]+ [0-9:.]+ corridor-test info round 3\n$");
}

TEST(Program, ThatDiesWithItsParentIsAskedToStop) {
  int pipe_ends[2];
  ASSERT_EQ(pipe(pipe_ends), 0);
  const pid_t parent = fork();
  if (parent == 0) {
    if (fork() == 0) {
      const int status = run_program("orphan", true, [&] {
        write(pipe_ends[1], "r", 1);  // ready: the parent may die
        while (!stop_requested()) poll(nullptr, 0, 10);
        return 0;
      });
      write(pipe_ends[1], status == 0 ? "s" : "f", 1);
      _exit(0);
    }
    char ready = 0;
    read(pipe_ends[0], &ready, 1);
    _exit(ready == 'r' ? 0 : 1);
  }
  int status = -1;
  waitpid(parent, &status, 0);
  EXPECT_EQ(status, 0);
  char result = 0;
  EXPECT_EQ(read(pipe_ends[0], &result, 1), 1);
  EXPECT_EQ(result, 's');
  close(pipe_ends[0]);
  close(pipe_ends[1]);
}

}  // namespace
}  // namespace corridor
