// SPDX-License-Identifier: Apache-2.0
#include "cluster/launch/children.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "proto/base/failure.h"
#include "proto/system/files.h"
#include "proto/system/identity.h"
#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

using std::chrono::seconds;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

const Silence kSilence{seconds(30), seconds(30)};

constexpr TimePoint at(int second) { return TimePoint(seconds(second)); }

class ChildrenTest : public testing::Test {
 protected:
  // `commands` of a shell.
  ProcessPlan script(const std::string& name, const std::string& commands) const {
    return {name, {"/bin/sh", "-c", commands}, log(name)};
  }
  std::filesystem::path log(const std::string& name) const {
    return temporary_.path() / (name + ".log");
  }
  std::string pipe(const std::string& name) const {
    const std::string path = temporary_.path() / name;
    EXPECT_EQ(mkfifo(path.c_str(), 0600), 0);
    return path;
  }
  // One that has given no sign of life, and gives none: a stopped shell.
  void start_silent(const std::string& name) {
    children_.start(script(name, "kill -STOP $$"));
    siginfo_t info{};
    EXPECT_EQ(waitid(P_ALL, 0, &info, WSTOPPED), 0);
  }
  // The next that ends, once it has.
  Ended next_end() {
    siginfo_t info{};
    EXPECT_EQ(waitid(P_ALL, 0, &info, WEXITED | WNOWAIT), 0);
    return children_.reap().value();
  }

  // Looks every second; returns the last.
  int pass(int from, int to) {
    for (int second = from; second <= to; ++second) children_.kill_hung(kSilence, at(second));
    return to;
  }

  testing_support::TemporaryDirectory temporary_;
  Children children_;
};

TEST_F(ChildrenTest, AreThereFromTheirStartUntilTheyAreReaped) {
  children_.start(script("good", "exit 0"));
  EXPECT_TRUE(children_.has("good"));
  EXPECT_FALSE(children_.has("other"));
  const Ended ended = next_end();
  EXPECT_EQ(ended.name, "good");
  EXPECT_TRUE(ended.well());
  EXPECT_FALSE(children_.has("good"));
  EXPECT_EQ(children_.size(), 0u);
  EXPECT_EQ(children_.reap().has_value(), false);
}

TEST_F(ChildrenTest, KnowWhyWhenTheyEndByThemselvesWithAFailuresStatus) {
  children_.start(script("knows", "exit 1"));
  EXPECT_TRUE(next_end().knows_why());
  children_.start(script("other", "exit 3"));
  EXPECT_FALSE(next_end().knows_why());
  children_.start(script("killed", "kill -9 $$"));
  const Ended killed = next_end();
  EXPECT_FALSE(killed.knows_why());
  EXPECT_FALSE(killed.well());
}

TEST_F(ChildrenTest, TheirCauseIsTheLastErrorOfTheirOwnLines) {
  std::ofstream(log("actor")) << "error: of an earlier process\n";
  children_.start(script("actor", "echo error: first; echo error: last; echo bye; exit 1"));
  EXPECT_EQ(next_end().cause(),
            "actor ended with status 1: error: last; log: " + log("actor").string());
  children_.start(script("actor", "echo only this; exit 2"));
  EXPECT_THAT(next_end().cause(), HasSubstr("status 2: its last line: only this; log:"));
  children_.start(script("actor", "exit 2"));
  EXPECT_THAT(next_end().cause(), HasSubstr("status 2: it wrote nothing; log:"));
  children_.start(script("actor", "kill -9 $$"));
  EXPECT_THAT(next_end().cause(), HasSubstr("actor ended with signal 9 (Killed); log:"));
}

TEST_F(ChildrenTest, ThatCannotBeStartedAreNamedAndReapedLater) {
  EXPECT_THAT(
      [&] {
        children_.start({"actor", {"/nowhere/program"}, log("actor")});
      },
      ThrowsMessage<Failure>(
          AllOf(HasSubstr("cannot start actor: /nowhere/program"), HasSubstr("No such file"))));
  EXPECT_THAT(
      [&] {
        children_.start({"actor", {"/bin/sh"}, "/nowhere/actor.log"});
      },
      ThrowsMessage<Failure>(HasSubstr("cannot write /nowhere/actor.log")));
  EXPECT_EQ(WEXITSTATUS(next_end().status), 127);
}

TEST_F(ChildrenTest, AreToldTheHowManiethStartTheirsIs) {
  const std::string environment = start_environment(1);
  const std::string variable = environment.substr(0, environment.find('='));
  for (int i = 0; i < 3; ++i) {
    children_.start(script("actor", "echo $" + variable));
    next_end();
  }
  EXPECT_EQ(read_file(log("actor")), "1\n2\n3\n");
}

TEST_F(ChildrenTest, OfWhichAllOrOneGetsASignal) {
  for (const char* name : {"one", "two", "three"}) children_.start(script(name, "exec sleep 600"));
  children_.signal(SIGTERM, "two");
  EXPECT_EQ(next_end().name, "two");
  children_.signal(SIGINT);
  EXPECT_EQ(WTERMSIG(next_end().status), SIGINT);
  EXPECT_EQ(WTERMSIG(next_end().status), SIGINT);
}

TEST_F(ChildrenTest, WhosePulseStandsStillForTooLongAreKilledAsHung) {
  start_silent("silent");
  const int end = pass(1000, 1029);
  EXPECT_EQ(children_.reap().has_value(), false);
  pass(end, end + 1);
  const Ended ended = next_end();
  EXPECT_EQ(ended.hung_s, 30.0);
  EXPECT_FALSE(ended.knows_why());
  EXPECT_EQ(
      ended.cause(),
      "silent was killed, since it gave no sign of life for 30 s (run.peer_timeout_s); log: " +
          log("silent").string());
}

TEST_F(ChildrenTest, AreNotHungWhileItIsWeWhoWereStopped) {
  start_silent("silent");
  pass(0, 20);
  children_.kill_hung(kSilence, at(5000));  // an hour on: nobody has looked
  EXPECT_EQ(children_.reap().has_value(), false);
}

TEST_F(ChildrenTest, GetTwiceTheTimeOnceTheyHaveBeenKilledForTheirSilence) {
  int second = 0;
  for (const int longest : {30, 60, 120, 240, 240}) {
    start_silent("slow");
    second = pass(second, second + longest - 1);
    EXPECT_EQ(children_.reap().has_value(), false) << longest;
    second = pass(second, second + 1);
    EXPECT_EQ(next_end().hung_s, longest);
  }
}

TEST_F(ChildrenTest, ThatComputeWithoutASignOfLifeAreHungToo) {
  children_.start(script("busy", "while :; do :; done"));
  Ended ended;
  int second = 0;
  while (true) {
    second = pass(second, second + 1);
    if (const auto end = children_.reap()) {
      ended = *end;
      break;
    }
    ASSERT_LT(second, 1'000'000);
  }
  EXPECT_TRUE(ended.hung_s);
}

TEST_F(ChildrenTest, WhosePulseGoesOnAreNotHungHoweverLongTheyLive) {
  // Its pulse is the memory behind a descriptor: the shell writes the byte that it is told.
  const std::string beat = pipe("beat"), beaten = pipe("beaten");
  children_.start(script("living",
                         "while read byte; do\n"
                         "printf \"\\\\$byte\" 1<> /proc/self/fd/$CORRIDOR_PULSE\n"
                         "echo > " +
                             beaten + "\ndone < " + beat));
  std::ofstream tell(beat);
  for (int i = 0; i < 4; ++i) {
    tell << "00" << i << std::endl;
    std::string told;
    std::getline(std::ifstream(beaten), told);
    pass(29 * i, 29 * (i + 1));
  }
  children_.signal(SIGTERM);
  const Ended ended = next_end();
  EXPECT_FALSE(ended.hung_s);
  EXPECT_EQ(WTERMSIG(ended.status), SIGTERM);
}

TEST_F(ChildrenTest, NoneIsLeftWhenAllAreKilled) {
  children_.start(script("sleeps", "exec sleep 600"));
  children_.start(script("deaf", "trap '' TERM INT HUP; while :; do sleep 600; done"));
  children_.kill_all();
  EXPECT_EQ(children_.size(), 0u);
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
}

}  // namespace
}  // namespace corridor::cluster
