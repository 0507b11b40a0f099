// SPDX-License-Identifier: Apache-2.0
#include "proto/wire/endpoint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netdb.h>
#include <sys/time.h>
#include <unistd.h>

#include <csignal>
#include <thread>
#include <zmq.hpp>

#include "proto/base/format.h"
#include "proto/base/random.h"
#include "proto/system/identity.h"
#include "tests/proto/wire/raw_peers.h"
#include "tests/support/failure_of.h"
#include "tests/support/manual_clock.h"

namespace corridor {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;
using testing_support::bytes_of;
using testing_support::FlakyLink;
using testing_support::kRun;
using testing_support::kSoon;
using testing_support::ManualClock;
using testing_support::RawClient;
using testing_support::RawServer;
using testing_support::text_of;

constexpr Duration kBrief{5};

Address fresh_address() {
  static int count = 0;
  return fmt::format("ipc://@corridor-test-{}-{}", getpid(), count++);
}

ClientIdentity actor(std::uint32_t index, std::uint64_t incarnation = 1) {
  return {kRun, Role::kActor, index, incarnation};
}

ClientLimits quick() { return {.resend_after = kBrief, .peer_timeout = kSoon, .window = 8}; }

TEST(Endpoint, ARequestIsAnswered) {
  const Address address = fresh_address();
  Server server(address, kRun);
  Client client(address, "server", actor(3, 77), {});
  EXPECT_EQ(client.send(bytes_of("question")), 1U);
  EXPECT_EQ(client.unanswered(), 1U);
  const auto request = server.receive(kSoon);
  ASSERT_TRUE(request);
  EXPECT_EQ(text_of(request->body), "question");
  EXPECT_EQ(request->client, (ClientId{Role::kActor, 3}));
  EXPECT_EQ(request->incarnation, 77U);
  server.reply(*request, bytes_of("answer"));
  EXPECT_EQ(text_of(client.receive(kSoon).value()), "answer");
  EXPECT_EQ(client.unanswered(), 0U);
  EXPECT_EQ(server.dropped(), 0U);
}

TEST(Endpoint, EmptyAndLargeBodiesPass) {
  const Address address = fresh_address();
  Server server(address, kRun);
  Client client(address, "server", actor(0), {});
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{20'000'000}}) {
    client.send(Bytes(size, std::byte{7}));
    const auto request = server.receive(kSoon);
    ASSERT_TRUE(request);
    EXPECT_EQ(text_of(request->body), std::string(size, '\7'));
    server.reply(*request, bytes_of(text_of(request->body)));
    EXPECT_EQ(text_of(client.receive(kSoon).value()), std::string(size, '\7'));
  }
}

TEST(Endpoint, NothingComesWithinThePatienceIsNoError) {
  const Address address = fresh_address();
  Server server(address, kRun);
  Client client(address, "server", actor(0), {});
  EXPECT_FALSE(server.receive(kBrief));
  client.send({});
  EXPECT_FALSE(client.receive(kBrief));
}

TEST(Endpoint, PipelinedAnswersComeInTheOrderOfTheRequestsWhateverTheServersOrder) {
  const Address address = fresh_address();
  Server server(address, kRun);
  Client client(address, "server", actor(0), {});
  std::vector<IncomingRequest> requests;
  for (int i = 0; i < 8; ++i) client.send(bytes_of(std::to_string(i)));
  for (int i = 0; i < 8; ++i) {
    requests.push_back(server.receive(kSoon).value());
    EXPECT_EQ(text_of(requests.back().body), std::to_string(i));
  }
  for (int i = 7; i >= 0; --i)
    server.reply(requests[static_cast<std::size_t>(i)], bytes_of(fmt::format("r{}", i)));
  for (int i = 0; i < 8; ++i)
    EXPECT_EQ(text_of(client.receive(kSoon).value()), fmt::format("r{}", i));
}

TEST(Endpoint, ClientsDoNotGetEachOthersAnswers) {
  const Address address = fresh_address();
  Server server(address, kRun);
  Client one(address, "server", actor(1), {});
  Client two(address, "server", actor(2), {});
  Client learner(address, "server", {kRun, Role::kLearner, 1, 1}, {});
  one.send(bytes_of("1"));
  two.send(bytes_of("2"));
  learner.send(bytes_of("L"));
  std::vector<IncomingRequest> requests;
  for (int i = 0; i < 3; ++i) requests.push_back(server.receive(kSoon).value());
  for (const auto& request : requests) server.reply(request, bytes_of(text_of(request.body)));
  EXPECT_EQ(text_of(one.receive(kSoon).value()), "1");
  EXPECT_EQ(text_of(two.receive(kSoon).value()), "2");
  EXPECT_EQ(text_of(learner.receive(kSoon).value()), "L");
}

TEST(Endpoint, ARepeatedRequestIsCarriedOutOnceAndAnsweredAgain) {
  const Address address = fresh_address();
  Server server(address, kRun);
  RawClient raw(address);
  raw.request(1, "a");
  raw.request(1, "a");
  raw.request(2, "b");
  const auto first = server.receive(kSoon);
  const auto second = server.receive(kSoon);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(second->sequence, 2U);
  const auto pending = raw.receive();
  EXPECT_EQ(pending.first.kind, MessageKind::kPending);
  EXPECT_EQ(pending.first.sequence, 1U);

  server.reply(*first, bytes_of("A"));
  EXPECT_EQ(raw.receive().second, "A");
  raw.request(1, "a");
  raw.request(3, "c");
  EXPECT_EQ(server.receive(kSoon)->sequence, 3U);
  const auto again = raw.receive();
  EXPECT_EQ(again.first.kind, MessageKind::kReply);
  EXPECT_EQ(again.first.sequence, 1U);
  EXPECT_EQ(again.second, "A");
  EXPECT_EQ(server.dropped(), 0U);
}

TEST(Endpoint, RequestsAheadOfALostOneWaitForItsRepetition) {
  const Address address = fresh_address();
  Server server(address, kRun);
  RawClient raw(address);
  for (const std::uint64_t sequence : {1, 3, 4, 2, 3, 4}) {
    raw.request(sequence, std::to_string(sequence));
  }
  for (std::uint64_t sequence = 1; sequence <= 4; ++sequence) {
    EXPECT_EQ(text_of(server.receive(kSoon)->body), std::to_string(sequence));
  }
}

TEST(Endpoint, EachRequestIsCarriedOutOnceAndInOrderOverALinkThatLosesAndRepeats) {
  const Address front = fresh_address();
  const Address back = fresh_address();
  Server server(back, kRun);
  FlakyLink link(front, back);
  Client client(front, "server", actor(0), quick());
  const std::uint64_t total = 300;
  std::uint64_t sent = 0, served = 0, answered = 0;
  // The first alone, as every client's `join`: it tells the server that this client is new.
  while (answered < total) {
    const std::size_t window = answered == 0 ? 1 : 8;
    while (client.unanswered() < window && sent < total) {
      ++sent;
      client.send(bytes_of(std::to_string(sent)));
    }
    link.pump();
    while (const auto request = server.receive(Duration::zero())) {
      ASSERT_EQ(text_of(request->body), std::to_string(++served));
      server.reply(*request, bytes_of(text_of(request->body)));
    }
    link.pump();
    if (const auto answer = client.receive(Duration(1))) {
      ASSERT_EQ(text_of(*answer), std::to_string(++answered));
    }
  }
  EXPECT_EQ(served, total);
}

TEST(Endpoint, GarbageIsDroppedAndCountedAndOthersAreServed) {
  const Address address = fresh_address();
  Server server(address, kRun);
  RawClient raw(address);
  std::uint64_t garbage = 0;
  for (std::uint64_t round = 0; round < 200; ++round, ++garbage) {
    std::vector<Bytes> frames(1 + round % 6);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      frames[i].resize(random_below(200, 3, Purpose::kWireDelay, {round, i}));
      for (std::size_t j = 0; j < frames[i].size(); ++j) {
        frames[i][j] = static_cast<std::byte>(random_bits(3, Purpose::kWireDelay, {round, i, j}));
      }
    }
    raw.send_frames(frames);
  }
  Header reply = RawClient::header(1);
  reply.kind = MessageKind::kReply;
  raw.send_frames({encode(reply), {}});
  raw.send_frames({encode(RawClient::header(0)), {}});
  raw.send_frames({encode(RawClient::header(1)), {}, {}});
  raw.request(1, "good");
  EXPECT_EQ(text_of(server.receive(kSoon)->body), "good");
  EXPECT_EQ(server.dropped(), garbage + 3);
}

TEST(Endpoint, ForeignProtocolsAndRunsAreRefusedAndToldWhy) {
  const Address address = fresh_address();
  Server server(address, kRun);
  RawClient raw(address);
  Header header = RawClient::header(1);
  header.protocol = 99;
  raw.send_frames({encode(header), {}});
  header = RawClient::header(1);
  header.run_id = std::string(32, 'b');
  raw.send_frames({encode(header), {}});
  while (server.dropped() < 2) ASSERT_FALSE(server.receive(kBrief));
  EXPECT_THAT(raw.receive().first.refusal,
              HasSubstr(fmt::format("protocol {}, you 99", kProtocolVersion)));
  EXPECT_THAT(raw.receive().first.refusal, HasSubstr("another run"));
}

TEST(Endpoint, ARefusedClientEndsWithTheServersText) {
  const Address address = fresh_address();
  Server server(address, kRun);
  Client client(address, "replay server", actor(0), {});
  client.send(bytes_of("?"));
  server.refuse(server.receive(kSoon).value(), "no such thing");
  EXPECT_EQ(failure_of([&] { client.receive(kSoon); }),
            "replay server at " + address + " refused: no such thing");
}

TEST(Endpoint, AnUndecodableBodyIsCountedAndRefused) {
  const Address address = fresh_address();
  Server server(address, kRun);
  Client client(address, "server", actor(0), {});
  client.send(bytes_of("?"));
  server.reject_malformed(server.receive(kSoon).value(), std::string(1000, 'x'));
  EXPECT_EQ(server.dropped(), 1U);
  EXPECT_THAT(failure_of([&] { client.receive(kSoon); }), HasSubstr("malformed request: xxx"));
}

TEST(Endpoint, ANewIncarnationTakesThePlaceOfTheOld) {
  const Address address = fresh_address();
  Server server(address, kRun);
  RawClient old_one(address), new_one(address);
  old_one.request(1, "old", 5);
  const auto old_request = server.receive(kSoon);
  new_one.request(1, "new", 6);
  const auto new_request = server.receive(kSoon);
  ASSERT_TRUE(old_request && new_request);
  EXPECT_EQ(text_of(new_request->body), "new");

  server.reply(*old_request, bytes_of("for the old"));  // dropped
  server.reply(*new_request, bytes_of("for the new"));
  EXPECT_EQ(new_one.receive().second, "for the new");

  old_one.request(2, "late", 5);
  new_one.request(2, "next", 6);
  // Between two connections there is no order.
  while (server.dropped() == 0) server.receive(kBrief);
  const auto refused = old_one.receive();
  EXPECT_EQ(refused.first.kind, MessageKind::kRefused);
  EXPECT_THAT(refused.first.refusal, HasSubstr("newer process"));
}

TEST(Endpoint, TheFirstMessageOfADeadPredecessorIsRefusedHoweverLateItComes) {
  const Address address = fresh_address();
  Server server(address, kRun);
  RawClient dead(address), successor(address);
  const std::uint64_t before = incarnation_of(1, ~std::uint64_t{0}), after = incarnation_of(2, 0);
  successor.request(1, "join", after);
  server.reply(server.receive(kSoon).value(), bytes_of("welcome"));
  EXPECT_EQ(successor.receive().second, "welcome");

  dead.request(1, "late join", before);
  while (server.dropped() == 0) ASSERT_FALSE(server.receive(kBrief));
  EXPECT_THAT(dead.receive().first.refusal, HasSubstr("newer process"));

  successor.request(2, "next", after);
  EXPECT_EQ(text_of(server.receive(kSoon).value().body), "next");
}

TEST(Endpoint, OfTwoLivingProcessesInOnePlaceOneIsRefusedForGood) {
  const Address address = fresh_address();
  Server server(address, kRun);
  Client first(address, "server", actor(0, incarnation_of(0, 1ull << 32)), quick());
  Client second(address, "server", actor(0, incarnation_of(0, 2ull << 32)), quick());
  first.send(bytes_of("first"));
  server.receive(kSoon).value();
  second.send(bytes_of("second"));
  const IncomingRequest request = server.receive(kSoon).value();
  EXPECT_EQ(text_of(request.body), "second");
  // The first asks again, and ends.
  const std::string failure = failure_of([&] {
    for (int i = 0; i < 2000; ++i) {
      first.receive(kBrief);
      ASSERT_FALSE(server.receive(kBrief));
    }
  });
  EXPECT_THAT(failure, HasSubstr("newer process has taken your place"));
  server.reply(request, bytes_of("answer"));
  EXPECT_EQ(text_of(second.receive(kSoon).value()), "answer");
}

TEST(Endpoint, AClientLearnsThatItsServerHasRestarted) {
  const Address address = fresh_address();
  auto server = std::make_unique<Server>(address, kRun);
  Client client(address, "learner", actor(0), quick());
  client.send({});
  server->reply(server->receive(kSoon).value(), {});
  ASSERT_TRUE(client.receive(kSoon));
  server.reset();
  server = std::make_unique<Server>(address, kRun);
  client.send({});
  const std::string failure = failure_of([&] {
    for (int i = 0; i < 2000; ++i) {
      EXPECT_FALSE(server->receive(kBrief));
      client.receive(kBrief);
    }
  });
  EXPECT_THAT(failure, HasSubstr("learner at " + address + " refused: it has restarted"));
}

TEST(Endpoint, AServerThatStartsLaterIsFound) {
  const Address address = fresh_address();
  Client client(address, "server", actor(0), quick());
  client.send(bytes_of("early"));
  EXPECT_FALSE(client.receive(kBrief));
  Server server(address, kRun);
  std::optional<IncomingRequest> request;
  for (int i = 0; i < 2000 && !request; ++i) {
    EXPECT_FALSE(client.receive(kBrief));
    request = server.receive(kBrief);
  }
  ASSERT_TRUE(request);
  EXPECT_EQ(text_of(request->body), "early");
}

TEST(Endpoint, ASilentPeerIsLostAfterTheTimeout) {
  const Address address = fresh_address();
  ManualClock time;
  Client client(address, "replay server", actor(0), {}, time.clock());
  client.send({});
  for (int second = 1; second < 30; ++second) {
    time.advance(seconds(1));
    ASSERT_FALSE(client.receive(Duration::zero()));
  }
  time.advance(seconds(1));
  EXPECT_EQ(failure_of([&] { client.receive(Duration::zero()); }),
            "replay server at " + address +
                " has been silent for 30 s: it has ended or cannot be reached");
}

TEST(Endpoint, TimeThatAClientSpendsElsewhereIsNoSilence) {
  ManualClock time;
  Client client(fresh_address(), "server", actor(0), {}, time.clock());
  client.send({});
  for (int look = 1; look < 30; ++look) {
    time.advance(std::chrono::hours(1));
    ASSERT_FALSE(client.receive(Duration::zero())) << "counts for a second each";
  }
  time.advance(std::chrono::hours(1));
  EXPECT_THAT(failure_of([&] { client.receive(Duration::zero()); }), HasSubstr("silent"));
}

TEST(Endpoint, AServerThatMakesAClientWaitIsNotLost) {
  const Address address = fresh_address();
  // Moves with each look alone. Three looks later the request is sent again; until it is answered
  // the client waits, in real time, for most of resend_after.
  ManualClock time;
  const Clock creeping = [&] {
    time.advance(std::chrono::milliseconds(400));
    return time.now();
  };
  const ClientLimits limits;
  const TimePoint start = time.now();
  RawServer server(address);
  Client client(address, "server", actor(0), limits, creeping);
  const std::jthread serving([&] {
    for (int repetition = 0; repetition <= 150; ++repetition) {
      Header header = server.receive();
      EXPECT_EQ(header.sequence, 1U);
      const bool last = repetition == 150;
      header.kind = last ? MessageKind::kReply : MessageKind::kPending;
      server.send_frames({encode(header), last ? bytes_of("at last") : Bytes{}});
    }
  });
  client.send({});
  const auto answer = client.receive(std::chrono::hours(1));
  EXPECT_EQ(text_of(answer.value()), "at last");
  EXPECT_GT(time.now() - start, 3 * limits.peer_timeout);
}

TEST(Endpoint, AnAddressInUseIsAFailure) {
  const Address ipc = fresh_address();
  Server first(ipc, kRun);
  EXPECT_THAT(failure_of([&] { Server second(ipc, kRun); }),
              testing::AllOf(HasSubstr(ipc), HasSubstr("another process listens there")));

  zmq::context_t context;
  zmq::socket_t other(context, zmq::socket_type::router);
  other.bind("tcp://127.0.0.1:*");
  const Address tcp = other.get(zmq::sockopt::last_endpoint);
  EXPECT_THAT(failure_of([&] { Server second(tcp, kRun); }),
              testing::AllOf(HasSubstr(tcp), HasSubstr("another process listens there")));
}

TEST(Endpoint, WhatIsNoAddressIsAFailure) {
  for (const char* bad :
       {"", "nonsense", "tcp://", "tcp://127.0.0.1", "tcp://192.0.2.1:5701", "smoke://signal"}) {
    EXPECT_THAT(failure_of([&] { Server server(bad, kRun); }), HasSubstr("cannot listen at"))
        << bad;
  }
  EXPECT_THAT(failure_of([&] { Client client("nonsense", "server", actor(0), {}); }),
              HasSubstr("nonsense is no address"));
}

TEST(Endpoint, HostNamesWorkOverTcp) {
  addrinfo* found = nullptr;
  if (getaddrinfo("localhost", nullptr, nullptr, &found) != 0) {
    GTEST_SKIP() << "this machine has no name for itself (localhost in /etc/hosts)";
  }
  freeaddrinfo(found);
  zmq::context_t context;
  Address address;
  {
    zmq::socket_t probe(context, zmq::socket_type::router);
    probe.bind("tcp://127.0.0.1:*");
    const Address bound = probe.get(zmq::sockopt::last_endpoint);
    address = "tcp://localhost" + bound.substr(bound.rfind(':'));
  }
  context.close();
  Server server(address, kRun);
  Client client(address, "server", actor(0), quick());
  client.send(bytes_of("over tcp"));
  std::optional<IncomingRequest> request;
  for (int i = 0; i < 2000 && !request; ++i) {
    request = server.receive(kBrief);
    client.receive(Duration::zero());
  }
  ASSERT_TRUE(request);
  server.reply(*request, bytes_of("too"));
  EXPECT_EQ(text_of(client.receive(kSoon).value()), "too");
}

TEST(Endpoint, AMessageOfAbsurdSizeClosesItsConnectionOnly) {
  const Address address = fresh_address();
  Server server(address, kRun, {.window = 8, .clients = 8, .message_bytes = 1000});
  ManualClock time;
  Client greedy(address, "server", actor(0), {}, time.clock());
  Client modest(address, "server", actor(1), {});
  greedy.send(Bytes(100'000));
  modest.send(Bytes(100));
  const auto request = server.receive(kSoon);
  ASSERT_TRUE(request);
  EXPECT_EQ(request->client.index, 1U);
  const auto pass = [&] {
    for (int second = 0; second < 30; ++second) {
      time.advance(seconds(1));
      greedy.receive(Duration::zero());
    }
  };
  EXPECT_THAT(failure_of(pass), HasSubstr("silent"));
  EXPECT_FALSE(server.receive(Duration::zero()));
}

TEST(Endpoint, TooManyUnansweredRequestsAreRefused) {
  const Address address = fresh_address();
  Server server(address, kRun, {.window = 2, .clients = 8});
  RawClient raw(address);
  for (std::uint64_t sequence = 1; sequence <= 3; ++sequence) raw.request(sequence, "");
  EXPECT_TRUE(server.receive(kSoon));
  EXPECT_TRUE(server.receive(kSoon));
  while (server.dropped() == 0) EXPECT_FALSE(server.receive(kBrief));
  EXPECT_THAT(raw.receive().first.refusal, HasSubstr("more than 2 unanswered"));
}

TEST(Endpoint, TooManyClientsAreRefused) {
  const Address address = fresh_address();
  Server server(address, kRun, {.window = 8, .clients = 1});
  RawClient raw(address);
  raw.request(1, "");
  Header other = RawClient::header(1);
  other.client.index = 1;
  raw.send_frames({encode(other), {}});
  EXPECT_TRUE(server.receive(kSoon));
  while (server.dropped() == 0) EXPECT_FALSE(server.receive(kBrief));
  EXPECT_THAT(raw.receive().first.refusal, HasSubstr("1 clients already"));
}

TEST(Endpoint, AServerThatAnswersNonsenseIsAFailure) {
  const std::vector<std::vector<Bytes>> nonsense = {
      {bytes_of("x")},
      {bytes_of("not a header"), {}},
      {encode(RawClient::header(1)), {}, {}},
      {encode(RawClient::header(1)), {}},  // a request
  };
  for (const auto& frames : nonsense) {
    const Address address = fresh_address();
    RawServer server(address);
    Client client(address, "server", actor(0), {});
    client.send({});
    server.receive();
    server.send_frames(frames);
    EXPECT_THAT(failure_of([&] { client.receive(kSoon); }), HasSubstr("nonsense"));
  }
}

TEST(Endpoint, ASignalEndsTheWaitEarly) {
  const Address address = fresh_address();
  Server server(address, kRun);
  struct sigaction action {
  }, previous{};
  action.sa_handler = [](int) {};
  sigaction(SIGALRM, &action, &previous);
  // Again and again, so that one before the wait does no harm.
  const itimerval every{{0, 10'000}, {0, 10'000}};
  setitimer(ITIMER_REAL, &every, nullptr);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_FALSE(server.receive(kSoon));
  EXPECT_LT(std::chrono::steady_clock::now() - start, kSoon / 2);
  const itimerval never{};
  setitimer(ITIMER_REAL, &never, nullptr);
  sigaction(SIGALRM, &previous, nullptr);
}

TEST(EndpointDeathTest, MisuseIsABug) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const Address address = fresh_address();
  EXPECT_DEATH(
      {
        Client client(address, "server", actor(0), {.window = 1});
        client.send({});
        client.send({});
      },
      "window 1");
}

}  // namespace
}  // namespace corridor
