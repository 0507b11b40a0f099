// SPDX-License-Identifier: Apache-2.0
#include "proto/run/manifest.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/base/json.h"
#include "proto/system/files.h"
#include "tests/support/failure_of.h"
#include "tests/support/some_manifest.h"
#include "tests/support/temporary_directory.h"

namespace corridor {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class Manifest : public testing::Test {
 protected:
  testing_support::TemporaryDirectory temporary_;
  RunDirectory run_ = RunDirectory::create(temporary_.path() / "run");
  RunManifest manifest_ = testing_support::some_manifest({});
};

TEST_F(Manifest, IsReadAsItWasWritten) {
  write_manifest(run_, manifest_);
  EXPECT_EQ(read_manifest(run_), manifest_);
  manifest_.fingerprint = "0123456789abcdef";
  write_manifest(run_, manifest_);
  EXPECT_EQ(read_manifest(run_), manifest_);
  EXPECT_EQ(manifest_.scenario_name(), "fake");
}

TEST_F(Manifest, HasWhatATrainingWentOnWithOtherwise) {
  EXPECT_EQ(manifest_.versions_now(), manifest_.versions);
  RunVersions other = manifest_.versions;
  other.sumo = "1.18.0";
  manifest_.continuations = {{7, other, {"sumo 1.18.0, where it was 1.15.0"}}};
  write_manifest(run_, manifest_);
  EXPECT_EQ(read_manifest(run_), manifest_);
  EXPECT_EQ(read_manifest(run_).versions_now(), other);
}

TEST_F(Manifest, NamesTheVersionsOnWhichBitsDepend) {
  const RunVersions before = manifest_.versions;
  RunVersions now = before;
  now.git_commit = "another";
  now.blas_core = "Haswell";
  EXPECT_EQ(changed_versions(before, now).size(), 0u) << "a run that does not say the kernels";
  now.sumo = "1.18.0";
  RunVersions then = before;
  then.blas_core = "Prescott";
  const std::vector<ChangedVersion> changed = changed_versions(then, now);
  ASSERT_EQ(changed.size(), 2u);
  EXPECT_EQ(changed[0].name, "sumo");
  EXPECT_EQ(changed[0].now, "1.18.0");
  EXPECT_EQ(changed[1].before, "Prescott");
}

TEST_F(Manifest, OfAnExportedRunLetsResultsGoBelowTheWorkingDirectory) {
  write_manifest(run_, manifest_);
  EXPECT_EQ(results_folder(run_), run_.root());
  manifest_.fingerprint = "0123456789abcdef";
  write_manifest(run_, manifest_);
  EXPECT_EQ(results_folder(run_), "evaluated/run");
  manifest_.trained = "/somewhere";
  write_manifest(run_, manifest_);
  EXPECT_EQ(results_folder(run_), run_.root()) << "it holds results itself";
}

TEST_F(Manifest, OfTheTrainedNetworksInTheRepositoryIsWrittenAgainWithTheSameBytes) {
  const auto trained =
      RunDirectory::open(std::filesystem::path(CORRIDOR_SOURCE_DIR) / "scenarios/trained/paper");
  const RunManifest manifest = read_manifest(trained);
  EXPECT_EQ(manifest.scenario_name(), "paper");
  write_manifest(run_, manifest);
  EXPECT_EQ(read_file(run_.manifest()), read_file(trained.manifest()));
}

TEST_F(Manifest, ThatIsMissingAMemberOrHasAnIdOfNoRunIsNamed) {
  const auto refusal = [&](const Json& json) {
    write_file(run_.manifest(), json.dump());
    return failure_of([&] { read_manifest(run_); });
  };
  const Json whole = json_of(manifest_);
  for (const auto& [name, value] : whole.items()) {
    Json without = whole;
    without.erase(name);
    EXPECT_THAT(refusal(without), AllOf(HasSubstr("manifest.json"), HasSubstr(name)));
  }
  for (const char* id : {"", "abc", "0123456789abcdef0123456789abcdeg"}) {
    Json other = whole;
    other["run_id"] = id;
    EXPECT_THAT(refusal(other), HasSubstr("run_id is not 32 hex digits"));
  }
  EXPECT_THAT(refusal(Json::array()), HasSubstr("manifest.json"));
}

}  // namespace
}  // namespace corridor
