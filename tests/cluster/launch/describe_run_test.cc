// SPDX-License-Identifier: Apache-2.0
#include "cluster/launch/describe_run.h"

#include <gtest/gtest.h>

namespace corridor::cluster {
namespace {

TEST(RunId, IsThirtyTwoHexDigitsAndNeverTheSame) {
  const std::string first = draw_run_id(), second = draw_run_id();
  EXPECT_EQ(first.size(), 32u);
  EXPECT_EQ(first.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(first, second);
}

TEST(RunManifestFile, SaysWhatMadeTheRun) {
  const std::string id = draw_run_id();
  const RunManifest manifest =
      describe_run(id, 42, "scenarios/paper.toml", "# settings", versions_here());
  EXPECT_EQ(manifest.run_id, id);
  EXPECT_EQ(manifest.seed, 42u);
  EXPECT_TRUE(manifest.scenario.ends_with("/scenarios/paper.toml"));
  EXPECT_GE(manifest.cores, 1u);
  EXPECT_EQ(manifest.config, "# settings");
  const RunVersions& versions = manifest.versions;
  for (const std::string& version : {versions.corridor, versions.git_commit, versions.sumo,
                                     versions.libtorch, versions.blas, versions.compiler}) {
    EXPECT_FALSE(version.empty());
  }
  EXPECT_FALSE(versions.blas_core) << "the learner alone knows";
  EXPECT_TRUE(std::isdigit(manifest.versions.sumo.front()));  // "1.15.0", say
  EXPECT_FALSE(manifest.fingerprint);
}

}  // namespace
}  // namespace corridor::cluster
