// SPDX-License-Identifier: Apache-2.0
// Kill anything at any time: a short chaos. `chaos` (chaos_main.cc) is the long one.
#include "tests/e2e/chaos.h"

#include "tests/e2e/run_support.h"

namespace corridor::e2e {
namespace {

TEST(Chaos, HoweverItIsDisturbedATrainingEndsWithTheSameBits) {
  TemporaryDirectory temporary;
  std::vector<std::string> longer = {"--set", "mop.steps=30000", "--set", "bp.steps=20000"};
  const auto undisturbed = temporary.path() / "undisturbed";
  ASSERT_EQ(run_command(train_command(undisturbed, longer), kDeadline_s).status, 0);
  const auto shared_memory = shared_memory_files();

  // Hung processes are to be found soon; an undisturbed run on a busy machine is to have its time.
  longer.insert(longer.end(), {"--set", "run.peer_timeout_s=4.5"});
  ChaosSettings settings;
  settings.run = temporary.path() / "run";
  settings.train = train_command(settings.run, longer);
  const auto at = std::find(settings.train.begin(), settings.train.end(), "--run");
  settings.train.erase(at, at + 2);
  settings.every_s = 0.8;
  settings.most = 14;
  settings.deadline_s = 1500.0;
  const ChaosResult result = train_in_chaos(settings, [](const Footprint&) {});
  EXPECT_EQ(result.trouble, "");
  EXPECT_EQ(result.fingerprint, fingerprint(undisturbed));
  EXPECT_EQ(shared_memory_files(), shared_memory);
  int disturbances = 0;
  for (const auto& [what, count] : result.disturbances) disturbances += count;
  EXPECT_GE(disturbances, 5);
  expect_nothing_left(settings.run);
}

}  // namespace
}  // namespace corridor::e2e
