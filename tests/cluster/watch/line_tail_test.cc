// SPDX-License-Identifier: Apache-2.0
#include "cluster/watch/line_tail.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class Tail : public testing::Test {
 protected:
  void append(const std::string& text) { std::ofstream(file_, std::ios::app) << text; }

  testing_support::TemporaryDirectory temporary_;
  std::filesystem::path file_ = temporary_.path() / "a.jsonl";
};

TEST_F(Tail, GivesEachLineOnceAndATornOneWhenItIsWhole) {
  LineTail tail(file_);
  EXPECT_THAT(tail.read(), IsEmpty());
  append("one\ntw");
  EXPECT_THAT(tail.read(), ElementsAre("one"));
  EXPECT_THAT(tail.read(), IsEmpty());
  append("o\nthree\n");
  EXPECT_THAT(tail.read(), ElementsAre("two", "three"));
}

TEST_F(Tail, LeavesOutWhatWasThereBeforeIt) {
  append("old\n");
  LineTail tail(file_);
  append("new\n");
  EXPECT_THAT(tail.read(), ElementsAre("new"));
}

TEST_F(Tail, BeginsAgainWhenTheFileIsWrittenAnew) {
  append("a long line\n");
  LineTail tail(file_);
  std::ofstream(file_) << "x\n";
  EXPECT_THAT(tail.read(), ElementsAre("x"));
}

}  // namespace
}  // namespace corridor::cluster
