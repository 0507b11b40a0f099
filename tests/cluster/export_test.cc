// SPDX-License-Identifier: Apache-2.0
#include "cluster/export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/base/failure.h"
#include "proto/run/checkpoints.h"
#include "tests/support/temporary_directory.h"
#include "tests/support/untrained_run.h"

namespace corridor::cluster {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(Export, OfATrainingThatIsNotCompleteIsRefusedAndLeavesNothing) {
  testing_support::TemporaryDirectory temporary;
  const RunDirectory run = testing_support::untrained_run(temporary.path() / "run");
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

TEST(Export, OfWhatIsExportedAndIntoTheRunItselfIsRefused) {
  testing_support::TemporaryDirectory temporary;
  const RunDirectory run = testing_support::untrained_run(temporary.path() / "run");
  EXPECT_THAT([&] { export_run(run.root(), run.root() / "log" / ".." / "x"); },
              ThrowsMessage<Failure>(HasSubstr("choose a place outside the run")));
  RunManifest manifest = read_manifest(run);
  manifest.fingerprint = "0123456789abcdef";
  write_manifest(run, manifest);
  write_file(run.networks(), "");
  EXPECT_THAT([&] { export_run(run.root(), temporary.path() / "to"); },
              ThrowsMessage<Failure>(HasSubstr("is exported already: copy its folder")));
  EXPECT_FALSE(std::filesystem::exists(temporary.path() / "to"));
}

}  // namespace
}  // namespace corridor::cluster
