// SPDX-License-Identifier: Apache-2.0
#include "cluster/launch/local.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <optional>

#include "proto/base/failure.h"
#include "tests/support/manual_clock.h"
#include "tests/support/processes.h"
#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::ThrowsMessage;
using testing_support::is_stopped;

// A shell's last line: goes on until a signal's trap ends it, and runs the traps of others.
constexpr const char* kForEver = "while :; do sleep 600 & wait $!; done";

// Long enough for a busy machine; nothing here takes as long when it works.
const Limits kLimits{.tick = Milliseconds(5),
                     .checkpoint = Milliseconds(10'000),
                     .others = Milliseconds(10'000),
                     .after_work = Milliseconds(10'000),
                     .repeated_signal = Milliseconds(0)};

class Local : public testing::Test {
 protected:
  // Signals that tests send may come after run_together, which watches them, has returned.
  Local() {
    for (const int sent : {SIGINT, SIGTERM}) signal(sent, [](int) {});
  }
  ~Local() override { prctl(PR_SET_CHILD_SUBREAPER, 0); }  // some tests set it

  // A shell script that first writes its process id into <name>.pid. `exec sleep` makes the shell
  // itself the sleeper. Scripts wait for each other by `event`s: neither sleeps for a while nor
  // spins.
  ProcessPlan script(const std::string& name, const std::string& commands) const {
    const std::string pid = file(name + ".pid");
    return {name,
            {"/bin/sh", "-c",
             "echo $$ > " + pid + ".new && mv " + pid + ".new " + pid + "\n" + commands},
            file(name + ".log")};
  }
  std::filesystem::path file(const std::string& name) const { return temporary_.path() / name; }
  // A new pipe: what `wait` waits for, and `tell` says, once for each `wait`.
  struct Event {
    std::string wait;
    std::string tell;
  };
  Event event(const std::string& name) const {
    const std::string pipe = file(name).string();
    EXPECT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    return {"read told < " + pipe + "\n", "echo > " + pipe + "\n"};
  }
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
  const Event ready = event("ready");
  const auto plan = {script("server", ready.tell + "exec sleep 600"), script("main", ready.wait)};
  EXPECT_EQ(run_together(plan, "main", kLimits, {}), 0);
  expect_gone("server");
}

TEST_F(Local, OneThatIgnoresTheRequestToEndIsKilled) {
  // From when it has been asked on, each look at the clock finds its time over once more.
  Limits limits = kLimits;
  limits.clock = [&, looks = 0]() mutable {
    if (exists("asked")) ++looks;
    return TimePoint(looks * kLimits.after_work);
  };
  const Event ready = event("ready");
  const auto plan = {
      script("deaf", "trap ': > " + file("asked").string() + "' TERM\n" + ready.tell + kForEver),
      script("main", ready.wait)};
  EXPECT_EQ(run_together(plan, "main", limits, {}), 0);
  EXPECT_TRUE(exists("asked"));
  expect_gone("deaf");
}

TEST_F(Local, WhatAProcessStartedItselfEndsWithIt) {
  // The main process leaves one in the background behind; as an orphan it comes to this process,
  // which can so wait for its end.
  ASSERT_EQ(prctl(PR_SET_CHILD_SUBREAPER, 1), 0);
  const std::string leave = "sleep 600 & echo $! > " + file("child.pid").string();
  EXPECT_EQ(run_together({script("main", leave)}, "main", kLimits, {}), 0);
  int status = 0;
  ASSERT_EQ(waitpid(pid_of("child"), &status, 0), pid_of("child"));
  EXPECT_EQ(WTERMSIG(status), SIGKILL);
}

TEST_F(Local, AFailureEndsAllAndSaysWhichProcessWhyAndWhereItsLogIs) {
  std::ofstream(file("actor.log")) << "error: of an earlier run\n";
  const Event main = event("main"), server = event("server");
  const auto plan = {script("main", main.tell + "exec sleep 600"),
                     script("server", server.tell + "exec sleep 600"),
                     script("actor", main.wait + server.wait +
                                         "echo actor: error: SUMO is missing >&2\n"
                                         "echo bye; exit 1")};
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
  EXPECT_EQ(run_together({plan}, "main", kLimits, supervision), 0);
  EXPECT_EQ(content("lives").size(), 2u * 12);
}

TEST_F(Local, AReplaceableProcessIsStartedAgainByItself) {
  const std::string starts = file("starts").string();
  const Event third = event("third");
  ProcessPlan actor =
      script("actor", "echo x >> " + starts + "; [ $(wc -l < " + starts +
                          ") -ge 3 ] || kill -9 $$\n" + third.tell + "exec sleep 600");
  actor.replaceable = true;
  const auto plan = {actor,
                     script("main", "echo x >> " + file("mains").string() + "\n" + third.wait)};
  std::vector<std::string> deaths;
  Supervision supervision;
  supervision.died = [&](const Ended& ended, bool all) {
    EXPECT_FALSE(all);
    deaths.push_back(ended.cause());
  };
  EXPECT_EQ(run_together(plan, "main", kLimits, supervision), 0);
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
  EXPECT_EQ(run_together(plan, "main", kLimits, supervision), 0);
  EXPECT_EQ(told, 1);
}

TEST_F(Local, OneThatEndsWellBeforeTheWorkIsDoneIsMissed) {
  // But not when that is its way.
  ProcessPlan actor = script("actor", "exit 0");
  actor.ends_by_itself = true;
  const std::string servers = file("servers").string();
  const Event second = event("second");
  const auto plan = {actor,
                     script("server", "echo x >> " + servers + "; [ $(wc -l < " + servers +
                                          ") -ge 2 ] || exit 0\n" + second.tell + "exec sleep 600"),
                     script("main", second.wait)};
  std::vector<std::string> died;
  Supervision supervision;
  supervision.died = [&](const Ended& ended, bool) { died.push_back(ended.name); };
  EXPECT_EQ(run_together(plan, "main", kLimits, supervision), 0);
  EXPECT_THAT(died, testing::ElementsAre("server"));
}

TEST_F(Local, OneWithoutASignOfLifeIsKilledAndStartedAgain) {
  // The first is stopped, as by a debugger or a dead disk, and from then on time passes.
  const std::string starts = file("starts").string();
  const auto plan = script(
      "main", "echo x >> " + starts + "; [ $(wc -l < " + starts + ") -ge 2 ] || kill -STOP $$");
  testing_support::ManualClock time;
  Limits limits = kLimits;
  limits.clock = time.clock();
  std::string cause;
  Supervision supervision = ticking([&] {
    if (pid_of("main") > 0 && is_stopped(pid_of("main"))) time.advance(std::chrono::seconds(1));
  });
  supervision.died = [&](const Ended& ended, bool) { cause = ended.cause(); };
  EXPECT_EQ(run_together({plan}, "main", limits, supervision), 0);
  EXPECT_THAT(cause, HasSubstr("main was killed, since it gave no sign of life"));
  EXPECT_GE(time.now(), TimePoint(kLimits.silence.loading));
  EXPECT_EQ(content("starts"), "x\nx\n");
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
                                        file("main.ready").string() + "\n" + kForEver)};
  const int signal = run_together(plan, "main", kLimits, ticking([&] {
                                    if (exists("main.ready") && exists("server.pid"))
                                      kill(getpid(), SIGINT);
                                  }));
  EXPECT_EQ(signal, SIGINT);
  EXPECT_THAT(content("main.log"), EndsWith("together\n"));  // a shell may name its dead first
  expect_gone("server");
  expect_gone("main");
}

TEST_F(Local, ASecondSignalKillsAtOnceWhateverIsStillGoingOn) {
  // The main process answers the first signal with the second, and would go on for ever.
  const auto plan = {script("main", "trap 'kill -INT " + std::to_string(getpid()) + "' TERM; : > " +
                                        file("main.ready").string() + "\n" + kForEver)};
  bool sent = false;
  testing_support::ManualClock stands_still;
  Limits limits = kLimits;
  limits.clock = stands_still.clock();
  const int signal = run_together(plan, "main", limits, ticking([&] {
                                    if (exists("main.ready") && !std::exchange(sent, true))
                                      kill(getpid(), SIGTERM);
                                  }));
  EXPECT_EQ(signal, SIGTERM);
  expect_gone("main");
}

TEST_F(Local, TheSameSignalTwiceInAMomentIsOne) {
  const auto plan = {script("main", "trap 'kill -TERM " + std::to_string(getpid()) +
                                        "; echo finished; exit 0' TERM; : > " +
                                        file("main.ready").string() + "\n" + kForEver)};
  testing_support::ManualClock stands_still;
  Limits limits = kLimits;
  limits.repeated_signal = Milliseconds(1);
  limits.clock = stands_still.clock();
  const int signal = run_together(plan, "main", limits, ticking([&] {
                                    if (exists("main.ready")) kill(getpid(), SIGTERM);
                                  }));
  EXPECT_EQ(signal, SIGTERM);
  EXPECT_THAT(content("main.log"), EndsWith("finished\n"));
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
  while (waitpid(-1, nullptr, 0) > 0) {  // a script's mv may still be at it
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
  EXPECT_EQ(run_queue(plan, 3, kLimits, [] {}), 0);
  std::ifstream counts(file("counts"));
  int lines = 0;
  for (int running; counts >> running; ++lines) EXPECT_LE(running, 3);
  EXPECT_EQ(lines, 8);
}

TEST_F(Local, AQueueEndsWithItsFirstFailure) {
  const Event good = event("good");
  const std::vector<ProcessPlan> plan = {script("good", good.tell + "exec sleep 600"),
                                         script("bad", good.wait + "exit 2"),
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
  testing_support::ManualClock time;
  Limits limits = kLimits;
  limits.clock = time.clock();
  limits.start = Milliseconds(0);
  int deaths = 0;
  Supervision supervision = ticking([&] {
    if (!exists("main.pid")) time.advance(std::chrono::seconds(1));
  });
  supervision.died = [&](const Ended& ended, bool) {
    EXPECT_TRUE(ended.hung_s);
    ++deaths;
  };
  run_together({script("main", "exit 0")}, "main", limits, supervision);
  EXPECT_EQ(deaths, 1);
  EXPECT_TRUE(exists("main.pid"));
}

}  // namespace
}  // namespace corridor::cluster
