// SPDX-License-Identifier: Apache-2.0
#include "proto/wire/connect.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/wire/codec.h"
#include "tests/support/failure_of.h"

namespace corridor {
namespace {

using testing::HasSubstr;

TEST(Addresses, OfTcpAreTheConfiguredPorts) {
  RunSettings settings;
  settings.transport = Transport::kTcp;
  settings.host = "node";
  const Addresses where = addresses(settings, std::string(32, 'a'), "/");
  EXPECT_EQ(where.replay, "tcp://node:5701");
  EXPECT_EQ(where.learner, "tcp://node:5702");
}

TEST(Addresses, OfIpcDifferByRunAndDoNotShowItsId) {
  const std::string one(32, 'a'), two(32, 'b');
  const Addresses where = addresses({}, one, "/");
  EXPECT_THAT(where.replay, testing::StartsWith("ipc://@corridor-"));
  EXPECT_NE(where.replay, where.learner);
  EXPECT_NE(where.replay, addresses({}, two, "/").replay);
  EXPECT_NE(where.replay, addresses({}, one, "/proc").replay) << "a copy of its directory";
  EXPECT_EQ(where.replay, addresses({}, one, "/usr/..").replay) << "the same, by another path";
  EXPECT_EQ(where.replay.find(one.substr(0, 8)), std::string::npos);
  EXPECT_LT(where.replay.size(), 100U);  // a Unix socket's name has 107
}

TEST(Expect, GivesTheReplyThatWasAskedForAndNamesThePeerOfAnyOther) {
  const Body body(encode(ReplayReply(Opened{7})));
  EXPECT_EQ(expect<Opened>(body, decode_replay_reply, "replay server").batches, 7u);
  EXPECT_THAT(failure_of([&] { expect<Saved>(body, decode_replay_reply, "replay server"); }),
              HasSubstr("the replay server answered another question"));
  const Body rubbish(Bytes(24));
  EXPECT_THAT(failure_of([&] { expect<Saved>(rubbish, decode_replay_reply, "replay server"); }),
              HasSubstr("the replay server's answer is malformed"));
}

}  // namespace
}  // namespace corridor
