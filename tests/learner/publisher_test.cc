// SPDX-License-Identifier: Apache-2.0
#include "learner/publisher.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/base/failure.h"
#include "proto/wire/codec.h"
#include "tests/learner/small_run.h"

namespace corridor::learner {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr Duration kPatience{5000};  // never used up when all is well

Weights weights_of(std::uint64_t version) {
  Weights weights{version, {}};
  weights.networks[NetworkId::kMop] = {static_cast<float>(version)};
  weights.networks[NetworkId::kBp] = {2.0f};
  return weights;
}

class PublisherTest : public testing::Test {
 protected:
  Client actor(std::uint32_t index) {
    return Client(address_, "learner", {kRunId, Role::kActor, index, fresh_incarnation()}, {});
  }
  static void ask(Client& client, std::uint64_t version) {
    client.send(encode(LearnerRequest(WeightsWanted{version})));
  }
  void report(Client& client, const SelectionOutcome& outcome) {
    client.send(encode(LearnerRequest(outcome)));
    publisher_.service(kPatience);
    EXPECT_EQ(answer(client), LearnerReply(Noted{}));
  }
  static LearnerReply answer(Client& client) {
    return decode_learner_reply(client.receive(kPatience).value());
  }
  std::string refusal(Client& client) {
    publisher_.service(kPatience);
    try {
      client.receive(kPatience);
    } catch (const Failure& failure) {
      return failure.what();
    }
    return "";
  }

  const std::string address_ = fresh_address("publisher");
  Server server_{address_, kRunId};
  Publisher publisher_{server_, 2};
};

TEST_F(PublisherTest, AnswersWithTheNewestTwoVersions) {
  for (const std::uint64_t version : {7, 8, 9}) publisher_.publish(weights_of(version));
  Client client = actor(0);
  for (const std::uint64_t version : {9, 8}) {
    ask(client, version);
    publisher_.service(kPatience);
    EXPECT_EQ(answer(client), LearnerReply(weights_of(version)));
  }
  ask(client, 7);
  EXPECT_THAT(refusal(client), HasSubstr("weights 7 wanted, 8 to 9 are kept"));
}

TEST_F(PublisherTest, ParksAQuestionUntilItsVersionIsPublished) {
  publisher_.publish(weights_of(0));
  Client first = actor(0), second = actor(1);
  ask(first, 1);
  publisher_.service(kPatience);
  ask(second, 2);
  publisher_.service(kPatience);
  EXPECT_FALSE(first.receive(Duration::zero()));
  publisher_.publish(weights_of(1));
  EXPECT_EQ(answer(first), LearnerReply(weights_of(1)));
  EXPECT_FALSE(second.receive(Duration::zero()));
  publisher_.publish(weights_of(2));
  EXPECT_EQ(answer(second), LearnerReply(weights_of(2)));
}

TEST_F(PublisherTest, AnswersARestartedActorsQuestionOnly) {
  publisher_.publish(weights_of(0));
  Client before = actor(0);
  ask(before, 1);
  publisher_.service(kPatience);
  Client after = actor(0);
  ask(after, 1);
  publisher_.service(kPatience);
  publisher_.publish(weights_of(1));
  EXPECT_EQ(answer(after), LearnerReply(weights_of(1)));
}

TEST_F(PublisherTest, SumsASelectionOnceAllActorsHaveReported) {
  publisher_.publish(weights_of(4));
  Client first = actor(0), second = actor(1);
  report(second, {5, 3, 30, 0.5, 2});
  EXPECT_EQ(publisher_.selection(5), std::nullopt);
  EXPECT_THAT(publisher_.awaited(5), ElementsAre(0));
  report(second, {5, 3, 30, 0.5, 2});  // again, after a restart: counts once
  report(first, {5, 4, 40, 1.25, 1});
  EXPECT_EQ(publisher_.selection(5), (SelectionOutcome{5, 7, 70, 1.75, 3}));
  EXPECT_EQ(publisher_.selection(4), std::nullopt);
}

TEST_F(PublisherTest, ForgetsTheSelectionsOfRoundsThatAreOver) {
  publisher_.publish(weights_of(4));
  Client first = actor(0), second = actor(1);
  report(first, {4, 1, 1, 1.0, 0});
  report(second, {4, 1, 1, 1.0, 0});
  publisher_.publish(weights_of(5));
  EXPECT_EQ(publisher_.selection(4), std::nullopt);
  report(first, {4, 1, 1, 1.0, 0});  // a late repetition
  report(second, {4, 1, 1, 1.0, 0});
  EXPECT_EQ(publisher_.selection(4), std::nullopt);
}

TEST_F(PublisherTest, RefusesWhatIsImpossible) {
  publisher_.publish(weights_of(4));
  Client stranger = actor(2);
  ask(stranger, 4);
  EXPECT_THAT(refusal(stranger), HasSubstr("client 2 of a run with 2 actors"));
  Client early = actor(0);
  early.send(encode(LearnerRequest(SelectionOutcome{6, 1, 1, 1.0, 0})));
  EXPECT_THAT(refusal(early), HasSubstr("round 6 before weights 5 exist"));
}

TEST_F(PublisherTest, RefusesAndCountsWhatIsMalformed) {
  publisher_.publish(weights_of(4));
  Client client = actor(0);
  client.send(Bytes(16, std::byte{0xff}));
  EXPECT_NE(refusal(client), "");
  EXPECT_EQ(server_.dropped(), 1u);
}

}  // namespace
}  // namespace corridor::learner
