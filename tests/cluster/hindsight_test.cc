// SPDX-License-Identifier: Apache-2.0
#include "cluster/hindsight.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/base/failure.h"
#include "tests/support/temporary_directory.h"
#include "tests/support/untrained_run.h"

namespace corridor::cluster {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(Hindsight, RefusesWhatHasNotBeenEvaluatedOrIsNot) {
  testing_support::TemporaryDirectory temporary;
  const RunDirectory directory = testing_support::untrained_run(temporary.path() / "run");
  const auto expect_refused = [&](HindsightOptions options, const char* text) {
    options.run = directory.root();
    EXPECT_THAT([&] { hindsight(options); }, ThrowsMessage<Failure>(HasSubstr(text)));
  };
  expect_refused({.planners = {"rules"}, .seeds = {5}},
                 "has not been evaluated with rules on seed 5");
  expect_refused({.planners = {"rulez"}, .seeds = {5}}, "rulez");
  expect_refused({.planners = {"rules", "rules"}, .seeds = {5}}, "twice");
  expect_refused({.planners = {"rules"}, .seeds = {5}, .jobs = 0}, "--jobs 0");
}

}  // namespace
}  // namespace corridor::cluster
