#include "cluster/new_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/base/failure.h"
#include "proto/system/files.h"
#include "tests/support/some_manifest.h"
#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

class ANewRun : public testing::Test {
 protected:
  testing_support::TemporaryDirectory temporary_;
  std::filesystem::path root_ = temporary_.path() / "run";
};

TEST_F(ANewRun, IsGoneUnlessItIsKept) {
  { const NewRun run(root_); }
  EXPECT_FALSE(std::filesystem::exists(root_));
  {
    NewRun run(root_);
    run.keep();
  }
  EXPECT_TRUE(std::filesystem::exists(root_));
}

TEST_F(ANewRun, HasWhatProcessesRead) {
  const NewRun run(root_);
  const RunManifest manifest = testing_support::some_manifest({});
  run.fill({}, "# settings", manifest);
  EXPECT_EQ(read_file(run.directory().config()), "# settings");
  EXPECT_EQ(read_manifest(run.directory()), manifest);
  EXPECT_TRUE(std::filesystem::exists(run.directory().network()));
  EXPECT_TRUE(std::filesystem::exists(run.directory().routes()));
}

TEST_F(ANewRun, OfADirectoryThatIsThereLeavesItAlone) {
  std::filesystem::create_directory(root_);
  write_file(root_ / "precious", "content");
  EXPECT_THROW(NewRun{root_}, Failure);
  EXPECT_EQ(read_file(root_ / "precious"), "content");
}

}  // namespace
}  // namespace corridor::cluster
