#include "cluster/launch/manifest.h"

#include <gtest/gtest.h>

#include "proto/base/json.h"
#include "proto/run/run_directory.h"
#include "proto/system/files.h"
#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

TEST(RunId, IsThirtyTwoHexDigitsAndNeverTheSame) {
  const std::string first = draw_run_id(), second = draw_run_id();
  EXPECT_EQ(first.size(), 32u);
  EXPECT_EQ(first.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(first, second);
}

TEST(RunManifestFile, SaysWhatMadeTheRunAndIsReadByTheOtherProcesses) {
  const std::string id = draw_run_id();
  const auto manifest = describe_run(id, 42, "scenarios/paper.toml", "# settings");
  EXPECT_EQ(manifest.at("seed"), 42);
  EXPECT_TRUE(manifest.at("scenario").get<std::string>().ends_with("/scenarios/paper.toml"));
  EXPECT_GE(manifest.at("cores"), 1);
  EXPECT_EQ(manifest.at("config"), "# settings");
  for (const char* version : {"corridor", "git_commit", "sumo", "libtorch", "blas", "compiler"}) {
    EXPECT_FALSE(manifest.at("versions").at(version).get<std::string>().empty()) << version;
  }
  // "1.15.0", say.
  EXPECT_TRUE(std::isdigit(manifest.at("versions").at("sumo").get<std::string>().front()));

  const testing_support::TemporaryDirectory temporary;
  const RunDirectory directory = RunDirectory::create(temporary.path() / "run");
  write_file(directory.manifest(), manifest.dump());
  EXPECT_EQ(read_manifest(directory).run_id, id);
}

}  // namespace
}  // namespace corridor::cluster
