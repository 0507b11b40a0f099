// SPDX-License-Identifier: Apache-2.0
#include "proto/system/processors.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "tests/support/temporary_directory.h"

namespace corridor {
namespace {

namespace fs = std::filesystem;

class Quota : public testing::Test {
 protected:
  void put(const fs::path& file, const std::string& text) const {
    fs::create_directories((root() / file).parent_path());
    std::ofstream(root() / file) << text << "\n";
  }
  const fs::path& root() const { return temporary_.path(); }

  testing_support::TemporaryDirectory temporary_;
};

TEST_F(Quota, IsTheLeastOfAllGroupsAround) {
  put("cpu.max", "max 100000");
  put("slurm/cpu.max", "300000 100000");
  put("slurm/job/cpu.max", "max 100000");
  EXPECT_EQ(quota_cores("0::/slurm/job/step", root()), 3.0);
  put("slurm/job/cpu.max", "50000 100000");
  EXPECT_EQ(quota_cores("0::/slurm/job/step", root()), 0.5);
  EXPECT_EQ(quota_cores("0::/slurm", root()), 3.0);
  EXPECT_EQ(quota_cores("0::/", root()), std::nullopt);
}

TEST_F(Quota, OfVersion1IsThatOfTheProcessorsController) {
  put("cpu/docker/cpu.cfs_quota_us", "150000");
  put("cpu/docker/cpu.cfs_period_us", "100000");
  EXPECT_EQ(quota_cores("5:memory:/other\n4:cpuacct,cpu:/docker\n", root()), 1.5);
  put("cpu/docker/cpu.cfs_quota_us", "-1");
  EXPECT_EQ(quota_cores("4:cpuacct,cpu:/docker\n", root()), std::nullopt);
}

TEST_F(Quota, OfWhatIsNoMembershipIsNone) {
  for (const char* text : {"", "\n", "0", "0:", "nonsense:cpu", "0::/not/there"}) {
    EXPECT_EQ(quota_cores(text, root()), std::nullopt) << text;
  }
}

TEST(AvailableCores, AreAtLeastOne) { EXPECT_GE(available_cores(), 1); }

TEST(ProcessorTimeOf, OneThatComputesHasSomeAndIsRunnable) {
  const ProcessorTime before = processor_time_of(getpid());
  volatile double sum = 0.0;
  while (processor_time_of(getpid()).had == before.had) sum = sum + 1.0;
  EXPECT_TRUE(processor_time_of(getpid()).runnable);
}

TEST(ProcessorTimeOf, OneThatIsStoppedIsNotRunnable) {
  const pid_t child = fork();
  if (child == 0) {
    while (true) pause();
  }
  kill(child, SIGSTOP);
  siginfo_t info{};
  ASSERT_EQ(waitid(P_PID, static_cast<id_t>(child), &info, WSTOPPED | WNOWAIT), 0);
  EXPECT_FALSE(processor_time_of(child).runnable);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_EQ(processor_time_of(child).had.count(), 0) << "it is gone";
}

}  // namespace
}  // namespace corridor
