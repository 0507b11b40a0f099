// SPDX-License-Identifier: Apache-2.0
#include "cluster/launch/run_lock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>

#include "proto/base/failure.h"
#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

class RunLockTest : public testing::Test {
 protected:
  testing_support::TemporaryDirectory temporary_;
  const std::filesystem::path& folder_ = temporary_.path();
};

TEST_F(RunLockTest, ARunThatIsGoingOnIsRefusedNamingItsOwner) {
  const Descriptor lock = lock_folder(folder_);
  EXPECT_THAT([&] { const Descriptor second = lock_folder(folder_); },
              ThrowsMessage<Failure>(AllOf(HasSubstr("is going on"),
                                           HasSubstr("process " + std::to_string(getpid())))));
}

TEST_F(RunLockTest, IsFreeAgainAfterwards) {
  lock_folder(folder_).close();
  EXPECT_NO_THROW(lock_folder(folder_).close());
}

TEST_F(RunLockTest, StaysWithTheProcessesOfALauncherThatDied) {
  // The launcher starts a process and dies; the process ends when the pipe is closed here.
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t launcher = fork();
  if (launcher == 0) {
    close(ends[1]);
    const Descriptor lock = lock_folder(folder_);
    if (fork() == 0) {
      char byte;
      _exit(read(ends[0], &byte, 1) == 0 ? 0 : 1);
    }
    _exit(0);
  }
  waitpid(launcher, nullptr, 0);
  EXPECT_THAT([&] { lock_folder(folder_, std::chrono::milliseconds(0)).close(); },
              ThrowsMessage<Failure>(HasSubstr("processes that it started still live")));
  close(ends[1]);
  EXPECT_NO_THROW(lock_folder(folder_, std::chrono::seconds(20)).close());
  close(ends[0]);
}

}  // namespace
}  // namespace corridor::cluster
