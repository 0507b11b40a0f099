// SPDX-License-Identifier: Apache-2.0
#include "actor/what_if.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>

#include "proto/base/failure.h"

namespace corridor::actor {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::ThrowsMessage;

// No copy is left, not even as a zombie.
void expect_no_copies() {
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

TEST(WhatIf, ReturnsTheResultAndNothingHasHappened) {
  int value = 1;
  const Bytes result = what_if(
      [&] {
        value = 2;
        return Bytes{static_cast<std::uint8_t>(value)};
      },
      10s);
  EXPECT_EQ(result, Bytes{2});
  EXPECT_EQ(value, 1);
  expect_no_copies();
}

TEST(WhatIf, ReturnsWhatAPipeDoesNotHoldAtOnceAndAlsoNothing) {
  Bytes large(1'000'000);
  for (std::size_t i = 0; i < large.size(); ++i) large[i] = static_cast<std::uint8_t>(i * 7);
  EXPECT_EQ(what_if([&] { return large; }, 10s), large);
  EXPECT_EQ(what_if([] { return Bytes(); }, 10s), Bytes());
}

TEST(WhatIf, AnExceptionBecomesAFailureWithItsText) {
  EXPECT_THAT([] { what_if([]() -> Bytes { throw std::runtime_error("{ no such road"); }, 10s); },
              ThrowsMessage<Failure>(HasSubstr("{ no such road")));
  expect_no_copies();
}

TEST(WhatIf, ADeathBecomesAFailureThatNamesTheSignal) {
  const auto die = []() -> Bytes {
    kill(getpid(), SIGKILL);
    return {};
  };
  EXPECT_THAT([&] { what_if(die, 10s); }, ThrowsMessage<Failure>(HasSubstr("signal 9")));
  EXPECT_THAT([] { what_if([]() -> Bytes { _exit(0); }, 10s); },
              ThrowsMessage<Failure>(HasSubstr("without a result")));
  expect_no_copies();
}

TEST(WhatIf, OneThatHangsIsKilledWhenPatienceEnds) {
  const auto hang = []() -> Bytes {
    while (true) pause();
  };
  EXPECT_THAT([&] { what_if(hang, 50ms); }, ThrowsMessage<Failure>(HasSubstr("after 50 ms")));
  expect_no_copies();
}

}  // namespace
}  // namespace corridor::actor
