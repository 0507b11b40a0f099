#include "cluster/export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/checkpoints.h"
#include "proto/failure.h"
#include "proto/run_config.h"
#include "proto/run_directory.h"
#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(Export, OfATrainingThatIsNotCompleteIsRefusedAndLeavesNothing) {
  testing_support::TemporaryDirectory temporary;
  const RunDirectory run = RunDirectory::create(temporary.path() / "run");
  write_file(run.config(), to_toml(RunConfig{}));
  write_file(run.manifest(), "{}");
  const auto to = temporary.path() / "to";
  const auto refused = [&] {
    EXPECT_THAT([&] { export_run(run.root(), to); },
                ThrowsMessage<Failure>(HasSubstr("is not complete")));
    EXPECT_FALSE(std::filesystem::exists(to));
  };
  refused();
  Checkpoints(run.checkpoints()).begin(9);
  Checkpoints(run.checkpoints()).commit(9, 2);
  refused();
}

}  // namespace
}  // namespace corridor::cluster
