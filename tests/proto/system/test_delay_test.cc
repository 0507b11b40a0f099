// SPDX-License-Identifier: Apache-2.0
#include "proto/system/test_delay.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "proto/base/failure.h"

namespace corridor {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

class TestDelayOf : public testing::Test {
 protected:
  ~TestDelayOf() override { unsetenv(kTestDelayVariable); }
};

TEST_F(TestDelayOf, NothingIsNone) { test_delay()(); }

TEST_F(TestDelayOf, NoMillisecondsIsNone) {
  setenv(kTestDelayVariable, "0", 1);
  test_delay()();
}

TEST_F(TestDelayOf, NonsenseIsRefused) {
  for (const char* text : {"", "soon", "5 ms", "-1", "1e6", "nan"}) {
    setenv(kTestDelayVariable, text, 1);
    EXPECT_THAT([] { test_delay(); }, ThrowsMessage<Failure>(HasSubstr("from 0 to 10000"))) << text;
  }
}

}  // namespace
}  // namespace corridor
