#include "cluster/launch/local.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <optional>

#include "proto/base/failure.h"
#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

// Long enough for a busy machine; nothing here takes as long when it works.
constexpr Limits kLimits{.tick = Milliseconds(5),
                         .checkpoint = Milliseconds(10'000),
                         .others = Milliseconds(10'000),
                         .after_work = Milliseconds(10'000),
                         .repeated_signal = Milliseconds(0)};

class Local : public testing::Test {
 protected:
  ~Local() override { prctl(PR_SET_CHILD_SUBREAPER, 0); }  // some tests set it

  // A shell script that first writes its process id into <name>.pid. `exec sleep` makes the shell
  // itself the sleeper.
  ProcessPlan script(const std::string& name, const std::string& commands) const {
    const std::string pid = file(name + ".pid");
    return {name,
            {"/bin/sh", "-c",
             "echo $$ > " + pid + ".new && mv " + pid + ".new " + pid + "\n" + commands},
            file(name + ".log")};
  }
  std::filesystem::path file(const std::string& name) const { return temporary_.path() / name; }
  bool exists(const std::string& name) const { return std::filesystem::exists(file(name)); }
  std::string content(const std::string& name) const {
    std::ifstream in(file(name));
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  }
  pid_t pid_of(const std::string& name) const {
    pid_t pid = 0;
    std::ifstream(file(name + ".pid")) >> pid;
    return pid;
  }
  // Whether a script has been started and its process is no more, a zombie included.
  void expect_gone(const std::string& name) const {
    ASSERT_GT(pid_of(name), 0) << name;
    EXPECT_FALSE(std::filesystem::exists("/proc/" + std::to_string(pid_of(name)))) << name;
  }
  static Supervision ticking(std::function<void()> tick) {
    Supervision supervision;
    supervision.tick = std::move(tick);
    return supervision;
  }

  testing_support::TemporaryDirectory temporary_;
};

TEST_F(Local, WhenTheMainProcessIsDoneTheOthersAreEnded) {
  const auto plan = {
      script("server", "exec sleep 600"),
      script("main", "while [ ! -e " + file("server.pid").string() + " ]; do :; done")};
  EXPECT_EQ(run_together(plan, "main", kLimits, {}).signal, 0);
  expect_gone("server");
}

TEST_F(Local, OneThatIgnoresTheRequestToEndIsKilled) {
  Limits limits = kLimits;
  limits.after_work = Milliseconds(20);
  const auto plan = {
      script("deaf",
             "trap '' TERM; : > " + file("deaf.ready").string() + "; while :; do sleep 600; done"),
      script("main", "while [ ! -e " + file("deaf.ready").string() + " ]; do :; done")};
  EXPECT_EQ(run_together(plan, "main", limits, {}).signal, 0);
  expect_gone("deaf");
}

TEST_F(Local, WhatAProcessStartedItselfEndsWithIt) {
  // The main process leaves one in the background behind; as an orphan it comes to this process,
  // which can so wait for its end.
  ASSERT_EQ(prctl(PR_SET_CHILD_SUBREAPER, 1), 0);
  const std::string leave = "sleep 600 & echo $! > " + file("child.pid").string();
  EXPECT_EQ(run_together({script("main", leave)}, "main", kLimits, {}).signal, 0);
  int status = 0;
  ASSERT_EQ(waitpid(pid_of("child"), &status, 0), pid_of("child"));
  EXPECT_EQ(WTERMSIG(status), SIGKILL);
}

TEST_F(Local, AFailureEndsAllAndSaysWhichProcessWhyAndWhereItsLogIs) {
  std::ofstream(file("actor.log")) << "error: of an earlier run\n";
  const auto plan = {
      script("main", "exec sleep 600"), script("server", "exec sleep 600"),
      script("actor", "while [ ! -e " + file("main.pid").string() + " -o ! -e " +
                          file("server.pid").string() +
                          " ]; do :; done\n"
                          "echo actor: error: SUMO is missing >&2; echo bye; exit 1")};
  EXPECT_THAT([&] { run_together(plan, "main", kLimits, {}); },
              ThrowsMessage<Failure>("actor ended with status 1: actor: error: SUMO is missing; "
                                     "log: " +
                                     file("actor.log").string()));
  expect_gone("main");
  expect_gone("server");
}

TEST_F(Local, OneThatDiesAgainAndAgainWithoutProgressIsAFailureThatSaysHow) {
  EXPECT_THAT([&] { run_together({script("main", "kill -9 $$")}, "main", kLimits, {}); },
              ThrowsMessage<Failure>(AllOf(HasSubstr("5 times in a row, without any progress"),
                                           HasSubstr("main ended with signal 9 (Killed); log:"))));
}

TEST_F(Local, WhileTheWorkAdvancesDeathsAreNoReasonToGiveUp) {
  // Dies as often as it takes.
  const std::string lives = file("lives").string();
  auto plan =
      script("main", "echo x >> " + lives + "; [ $(wc -l < " + lives + ") -ge 12 ] || kill -9 $$");
  Supervision supervision;
  std::uint64_t progress = 0;
  supervision.progress = [&] { return ++progress; };
  EXPECT_EQ(run_together({plan}, "main", kLimits, supervision).signal, 0);
  EXPECT_EQ(content("lives").size(), 2u * 12);
}

TEST_F(Local, AReplaceableProcessIsStartedAgainByItself) {
  const std::string starts = file("starts").string();
  ProcessPlan actor = script("actor", "echo x >> " + starts + "; [ $(wc -l < " + starts +
                                          ") -ge 3 ] || kill -9 $$; exec sleep 600");
  actor.replaceable = true;
  const auto plan = {actor,
                     script("main", "echo x >> " + file("mains").string() + "; until [ $(wc -l < " +
                                        starts + ") -ge 3 ]; do :; done 2> /dev/null")};
  std::vector<std::string> deaths;
  Supervision supervision;
  supervision.died = [&](const Ended& ended, bool all) {
    EXPECT_FALSE(all);
    deaths.push_back(ended.cause());
  };
  EXPECT_EQ(run_together(plan, "main", kLimits, supervision).signal, 0);
  EXPECT_EQ(content("mains"), "x\n");
  ASSERT_EQ(deaths.size(), 2u);
  EXPECT_THAT(deaths[0], HasSubstr("actor ended with signal 9"));
}

TEST_F(Local, WithAnyOtherAllAreStartedAnewAndNoneIsLeftWhenThatIsTold) {
  const std::string starts = file("starts").string();
  const auto plan = {
      script("server", "exec sleep 600"),
      script("main", "echo x >> " + starts + "; [ $(wc -l < " + starts + ") -ge 2 ] || exit 143")};
  int told = 0;
  Supervision supervision;
  supervision.died = [&](const Ended& ended, bool all) {
    EXPECT_TRUE(all);
    EXPECT_EQ(ended.name, "main");
    expect_gone("main");
    if (exists("server.pid")) expect_gone("server");
    ++told;
  };
  EXPECT_EQ(run_together(plan, "main", kLimits, supervision).signal, 0);
  EXPECT_EQ(told, 1);
}

TEST_F(Local, OneThatEndsWellBeforeTheWorkIsDoneIsMissed) {
  // But not when that is its way.
  ProcessPlan actor = script("actor", "exit 0");
  actor.ends_by_itself = true;
  const std::string servers = file("servers").string();
  const auto plan = {
      actor,
      script("server", "echo x >> " + servers + "; [ $(wc -l < " + servers +
                           ") -ge 2 ] || exit 0; exec sleep 600"),
      script("main", "until [ $(wc -l < " + servers + ") -ge 2 ]; do :; done 2> /dev/null")};
  std::vector<std::string> died;
  Supervision supervision;
  supervision.died = [&](const Ended& ended, bool) { died.push_back(ended.name); };
  EXPECT_EQ(run_together(plan, "main", kLimits, supervision).signal, 0);
  EXPECT_THAT(died, testing::ElementsAre("server"));
}

TEST_F(Local, OneWithoutASignOfLifeIsKilledAndStartedAgain) {
  // The first is stopped, as by a debugger or a dead disk; a shell has no pulse of its own, so that
  // the limit must be longer than the second takes.
  Limits limits = kLimits;
  limits.hung = Milliseconds(1000);
  const std::string starts = file("starts").string();
  const auto plan = script(
      "main", "echo x >> " + starts + "; [ $(wc -l < " + starts + ") -ge 2 ] || kill -STOP $$");
  std::string cause;
  Supervision supervision;
  supervision.died = [&](const Ended& ended, bool) { cause = ended.cause(); };
  EXPECT_EQ(run_together({plan}, "main", limits, supervision).signal, 0);
  EXPECT_THAT(cause, HasSubstr("main was killed, since it hung"));
}

TEST_F(Local, AProgramThatIsNotThereIsAFailureAndEndsThoseStartedBefore) {
  const ProcessPlan missing{"actor", {"/nowhere/corridor-actor"}, file("actor.log")};
  EXPECT_THAT(
      [&] {
        run_together({script("main", "exec sleep 600"), missing}, "main", kLimits, {});
      },
      ThrowsMessage<Failure>(AllOf(HasSubstr("cannot start actor: /nowhere/corridor-actor"),
                                   HasSubstr("No such file"))));
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "a child is left";
}

TEST_F(Local, ASignalStopsTheMainProcessFirstSoThatItCanFinishWithTheOthersHelp) {
  // The main process, told to stop, notes whether the server is still there.
  const auto plan = {script("server", "exec sleep 600"),
                     script("main", "trap 'kill -0 $(cat " + file("server.pid").string() +
                                        ") && echo together; exit 0' TERM; : > " +
                                        file("main.ready").string() + "; while :; do :; done")};
  const Ending ending = run_together(plan, "main", kLimits, ticking([&] {
                                       if (exists("main.ready") && exists("server.pid"))
                                         kill(getpid(), SIGINT);
                                     }));
  EXPECT_EQ(ending.signal, SIGINT);
  EXPECT_EQ(content("main.log"), "together\n");
  expect_gone("server");
  expect_gone("main");
}

TEST_F(Local, ASecondSignalKillsAtOnceWhateverIsStillGoingOn) {
  // The main process answers the first signal with the second, and would go on for ever.
  const auto plan = {script("main", "trap 'kill -INT " + std::to_string(getpid()) + "' TERM; : > " +
                                        file("main.ready").string() + "; while :; do :; done")};
  bool sent = false;
  Limits limits = kLimits;
  limits.checkpoint = Milliseconds(600'000);
  const Ending ending = run_together(plan, "main", limits, ticking([&] {
                                       if (exists("main.ready") && !std::exchange(sent, true))
                                         kill(getpid(), SIGTERM);
                                     }));
  EXPECT_EQ(ending.signal, SIGTERM);
  expect_gone("main");
}

TEST_F(Local, TheSameSignalTwiceInAMomentIsOne) {
  const auto plan = {script("main", "trap 'kill -TERM " + std::to_string(getpid()) +
                                        "; echo finished; exit 0' TERM; : > " +
                                        file("main.ready").string() + "; while :; do :; done")};
  Limits limits = kLimits;
  limits.repeated_signal = Milliseconds(600'000);
  const Ending ending = run_together(plan, "main", limits, ticking([&] {
                                       if (exists("main.ready")) kill(getpid(), SIGTERM);
                                     }));
  EXPECT_EQ(ending.signal, SIGTERM);
  EXPECT_EQ(content("main.log"), "finished\n");
}

TEST_F(Local, WhatTheWatcherThrowsLeavesNothingRunning) {
  EXPECT_THROW(run_together({script("main", "exec sleep 600")}, "main", kLimits, ticking([&] {
                              if (exists("main.pid")) throw Failure("no more");
                            })),
               Failure);
  expect_gone("main");
}

TEST_F(Local, ProcessesLiveInGroupsOfTheirOwnWithOneThreadEachAndNoInput) {
  const auto plan = {script("main",
                            "read line; echo \"threads $OMP_NUM_THREADS $OPENBLAS_NUM_THREADS, "
                            "input '$line', group $(ps -o pgid= -p $$ | tr -d ' '), pid $$\"")};
  run_together(plan, "main", kLimits, {});
  const std::string pid = std::to_string(pid_of("main"));
  EXPECT_EQ(content("main.log"), "threads 1 1, input '', group " + pid + ", pid " + pid + "\n");
}

TEST_F(Local, WhenTheLauncherIsKilledItsProcessesEnd) {
  // Orphans come to this process, so it can wait for them.
  ASSERT_EQ(prctl(PR_SET_CHILD_SUBREAPER, 1), 0);
  const pid_t launcher = fork();
  if (launcher == 0) {
    run_together({script("main", "exec sleep 600"), script("other", "exec sleep 600")}, "main",
                 kLimits, ticking([&] {
                   if (exists("main.pid") && exists("other.pid")) kill(getpid(), SIGKILL);
                 }));
    _exit(0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(launcher, &status, 0), launcher);
  ASSERT_EQ(WTERMSIG(status), SIGKILL);
  for (const char* name : {"main", "other"}) {
    ASSERT_EQ(waitpid(pid_of(name), &status, 0), pid_of(name));
    EXPECT_EQ(WTERMSIG(status), SIGKILL) << name;
  }
}

TEST_F(Local, AQueueRunsEveryProcessAndNoMoreAtATimeThanAllowed) {
  // Each notes how many are under way, itself included; the lock makes that exact.
  const std::string count = "flock " + file("lock").string() + " sh -c '";
  std::vector<ProcessPlan> plan;
  for (int i = 0; i < 8; ++i) {
    const std::string mine = file("running." + std::to_string(i)).string();
    plan.push_back(script("job-" + std::to_string(i),
                          count + "touch " + mine + "; ls " + temporary_.path().string() +
                              " | grep -c running >> " + file("counts").string() + "'\n" + count +
                              "rm " + mine + "'"));
  }
  EXPECT_EQ(run_queue(plan, 3, kLimits, [] {}).signal, 0);
  std::ifstream counts(file("counts"));
  int lines = 0;
  for (int running; counts >> running; ++lines) EXPECT_LE(running, 3);
  EXPECT_EQ(lines, 8);
}

TEST_F(Local, AQueueEndsWithItsFirstFailure) {
  const std::vector<ProcessPlan> plan = {
      script("good", "exec sleep 600"),
      script("bad", "while [ ! -e " + file("good.pid").string() + " ]; do :; done; exit 2"),
      script("never", "exit 0")};
  EXPECT_THAT([&] { run_queue(plan, 2, kLimits, [] {}); },
              ThrowsMessage<Failure>(HasSubstr("bad ended with status 2")));
  expect_gone("good");
  EXPECT_FALSE(exists("never.pid"));
}

// Set: the next process that is forked stops itself before it becomes a program.
bool stop_next_child = false;

TEST_F(Local, AProcessThatIsStoppedBeforeItIsItsProgramIsFoundAsHungAndStartedAgain) {
  ASSERT_EQ(pthread_atfork(
                nullptr, [] { stop_next_child = false; },
                [] {
                  if (stop_next_child) raise(SIGSTOP);
                }),
            0);
  stop_next_child = true;
  Limits limits = kLimits;
  limits.hung = Milliseconds(1000);
  int deaths = 0;
  Supervision supervision;
  supervision.died = [&](const Ended& ended, bool) {
    EXPECT_TRUE(ended.hung);
    ++deaths;
  };
  run_together({script("main", "exit 0")}, "main", limits, supervision);
  EXPECT_EQ(deaths, 1);
  EXPECT_TRUE(exists("main.pid"));
}

}  // namespace
}  // namespace corridor::cluster
