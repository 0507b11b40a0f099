// SPDX-License-Identifier: Apache-2.0
#include "proto/wire/codec.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>

#include "proto/base/random.h"
#include "proto/settings/transition.h"
#include "tests/support/batches.h"

namespace corridor {
namespace {

using testing_support::decoded_batch;
using testing_support::encoded;

std::vector<float> floats(std::size_t count) {
  std::vector<float> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(0.5F * static_cast<float>(i));
  return values;
}

Insert insert_of(std::size_t rows) {
  return {7, 2, floats(9 * rows), floats(rows), {3, {1, 2, 250}}};
}

Batch batch_of(std::size_t rows) {
  Batch batch{2, floats(9 * rows), {}, floats(rows)};
  for (std::size_t i = 0; i < rows; ++i) batch.keys.push_back(1000 + i);
  return batch;
}

std::vector<Header> headers() {
  Header refused{kProtocolVersion,      std::string(32, 'a'), Role::kLearner, 9, 1ULL << 60, 12,
                 MessageKind::kRefused, "no: \"x\""};
  Header request;
  request.run_id = "r";
  Header foreign;
  foreign.protocol = 77;
  foreign.kind = MessageKind::kPending;
  return {refused, request, foreign};
}
std::vector<ReplayRequest> replay_requests() {
  return {Join{},
          insert_of(0),
          insert_of(3),
          insert_of(500),
          OpenBlock{1ULL << 40},
          Step{{5, ~0ULL, 0}, {0.0F, 1.5F, 1e30F}, 64, 0.4},
          Step{},
          Save{"/runs/x/checkpoints/5.partial", "/runs/x/checkpoints/4"}};
}
std::vector<ReplayReply> replay_replies() {
  return {Joined{4, {2, std::vector<std::uint8_t>(999, 17)}}, Joined{}, Inserted{}, Opened{4},
          Saved{true}};
}
std::vector<LearnerRequest> learner_requests() {
  return {WeightsWanted{6}, SelectionOutcome{1, 2, 3, -4.5, 6}};
}
std::vector<LearnerReply> learner_replies() {
  return {Weights{6, {floats(101), floats(7)}}, Weights{}, Noted{}};
}

// Calls `use(bytes, decode again and encode)` with a message of every kind.
void for_each_message(
    const std::function<void(const Bytes&, const std::function<Bytes(ByteView)>&)>& use) {
  const auto all = [&](const auto& values, auto decode) {
    for (const auto& value : values) {
      use(encode(value), [&](ByteView bytes) { return encode(decode(bytes)); });
    }
  };
  all(headers(), decode_header);
  all(replay_requests(), decode_replay_request);
  all(replay_replies(), decode_replay_reply);
  all(learner_requests(), decode_learner_request);
  all(learner_replies(), decode_learner_reply);
}

TEST(Codec, EveryMessageComesBackEqual) {
  for (const auto& value : headers()) EXPECT_EQ(decode_header(encode(value)), value);
  for (const auto& value : replay_requests()) {
    EXPECT_EQ(decode_replay_request(encode(value)), value) << value.index();
  }
  for (const auto& value : replay_replies()) {
    EXPECT_EQ(decode_replay_reply(encode(value)), value) << value.index();
  }
  for (const auto& value : learner_requests()) {
    EXPECT_EQ(decode_learner_request(encode(value)), value) << value.index();
  }
  for (const auto& value : learner_replies()) {
    EXPECT_EQ(decode_learner_reply(encode(value)), value) << value.index();
  }
}

TEST(Codec, EqualValuesGiveEqualBytes) {
  for_each_message([](const Bytes& bytes, const auto& again) { EXPECT_EQ(again(bytes), bytes); });
}

TEST(Codec, AlignmentOfTheInputDoesNotMatter) {
  for_each_message([](const Bytes& bytes, const auto& again) {
    for (std::size_t shift = 0; shift < 8; ++shift) {
      Bytes moved(bytes.size() + shift);
      std::memcpy(moved.data() + shift, bytes.data(), bytes.size());
      EXPECT_EQ(again(ByteView(moved).subspan(shift)), bytes);
    }
  });
}

TEST(Codec, AMessageCutOffAnywhereIsMalformed) {
  for_each_message([](const Bytes& bytes, const auto& again) {
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      EXPECT_THROW(again(ByteView(bytes).first(size)), Malformed) << size;
    }
  });
}

TEST(Codec, AnythingAfterTheMessageIsMalformed) {
  for_each_message([](Bytes bytes, const auto& again) {
    for (int i = 0; i < 16; ++i) {
      bytes.push_back(std::byte{0});
      EXPECT_THROW(again(bytes), Malformed);
    }
  });
}

TEST(Codec, FlippedBytesGiveMalformedOrASmallValueNeverACrash) {
  std::uint64_t draw = 0;
  const auto below = [&](std::uint64_t bound) {
    return random_below(bound, 1, Purpose::kWireDelay, {draw++});
  };
  int malformed = 0;
  for_each_message([&](const Bytes& bytes, const auto& again) {
    for (int round = 0; round < 500; ++round) {
      Bytes damaged = bytes;
      const std::uint64_t flips = 1 + below(4);
      for (std::uint64_t i = 0; i < flips; ++i) {
        // Half of them in the first words, where the pointers are.
        const std::uint64_t range =
            below(2) == 0 ? std::min<std::size_t>(bytes.size(), 80) : bytes.size();
        damaged[below(range)] ^= static_cast<std::byte>(1 + below(255));
      }
      try {
        // What Cap'n Proto reads is at most four times what it was given.
        EXPECT_LE(again(damaged).size(), 5 * bytes.size() + 1024);
      } catch (const Malformed& error) {
        EXPECT_STRNE(error.what(), "");
        ++malformed;
      }
    }
  });
  EXPECT_GT(malformed, 1000);
}

TEST(Codec, RandomBytesAreMalformedOrHarmless) {
  for (std::uint64_t round = 0; round < 2000; ++round) {
    Bytes noise(8 * random_below(20, 2, Purpose::kWireDelay, {round}));
    for (std::size_t i = 0; i < noise.size(); ++i) {
      noise[i] = static_cast<std::byte>(random_bits(2, Purpose::kWireDelay, {round, i}));
    }
    EXPECT_THROW(decode_header(noise), Malformed);  // the segment table cannot fit
    EXPECT_THROW(decode_replay_request(noise), Malformed);
  }
}

template <typename Value>
void expect_malformed(const Value& value, const std::string& reason) {
  try {
    decode_replay_request(encode(ReplayRequest(value)));
    FAIL() << "decoded";
  } catch (const Malformed& error) {
    EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
  }
}

TEST(Codec, ABatchFilledInItsMessageIsLookedAtInPlace) {
  for (const std::size_t rows : {0, 1, 3, 1000}) {
    const Batch batch = batch_of(rows);
    const Body filled = encoded(batch);
    const ByteView bytes = filled;
    for (const std::size_t offset : {0, 1}) {  // aligned, and not
      Bytes moved(offset);
      moved.insert(moved.end(), bytes.begin(), bytes.end());
      const auto owner = std::make_shared<const Bytes>(moved);
      EXPECT_EQ(decoded_batch(Body(owner, ByteView(*owner).subspan(offset))), batch);
    }
    EXPECT_THROW(decode_replay_reply(filled), Malformed);
  }
}

TEST(Codec, AnotherReplyIsNoBatchAndADamagedOneIsMalformed) {
  EXPECT_FALSE(decode_batch(encode(ReplayReply(Inserted{}))).has_value());
  const Body whole = encoded(batch_of(3));
  const ByteView bytes = whole;
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_THROW(decode_batch(Bytes(bytes.begin(), bytes.begin() + static_cast<int>(size))),
                 Malformed);
  }
}

TEST(Codec, FlippedBytesOfABatchGiveMalformedOrAsManyKeysAndWeightsAsRows) {
  const Body whole = encoded(batch_of(3));
  const ByteView bytes = whole;
  int malformed = 0;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    for (int bit = 0; bit < 8; ++bit) {
      Bytes damaged(bytes.begin(), bytes.end());
      damaged[at] ^= static_cast<std::byte>(1 << bit);
      try {
        const std::optional<ReceivedBatch> batch = decode_batch(std::move(damaged));
        if (!batch) continue;  // another reply
        EXPECT_EQ(batch->keys.size(), batch->weights.size());
        const RowLayout layout{static_cast<int>(batch->observations)};
        EXPECT_EQ(batch->rows.size(), batch->keys.size() * layout.stride());
      } catch (const Malformed&) {
        ++malformed;
      }
    }
  }
  EXPECT_GT(malformed, 100);
}

TEST(Codec, RowsMustBeWhole) {
  Insert insert = insert_of(3);
  insert.rows.pop_back();
  expect_malformed(insert, "26 floats are not whole rows of 9");
  insert = insert_of(3);
  insert.observations = 4'000'000'000;
  expect_malformed(insert, "observations");
}

TEST(Codec, EveryRowNeedsAPriority) {
  Insert insert = insert_of(3);
  insert.priorities.pop_back();
  expect_malformed(insert, "2 priorities for 3 rows");
}

TEST(Codec, EveryKeyNeedsAPriority) {
  expect_malformed(Step{{1, 2}, {0.5F}, 1, 0.4}, "1 priorities for 2");
}

TEST(Codec, PrioritiesAreFiniteAndNotNegative) {
  for (const float bad :
       {-1.0F, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    expect_malformed(Step{{1}, {bad}, 1, 0.4}, "a priority of");
    Insert insert = insert_of(1);
    insert.priorities = {bad};
    expect_malformed(insert, "a priority of");
  }
}

TEST(Codec, CountAndExponentAreBounded) {
  expect_malformed(Step{{}, {}, 65'537, 0.4}, "65537 rows wanted");
  expect_malformed(Step{{}, {}, 1, std::numeric_limits<double>::quiet_NaN()}, "exponent");
}

TEST(Codec, WeightsNameEveryNetworkInItsPlace) {
  const Bytes good = encode(LearnerReply(Weights{6, {floats(3), floats(2)}}));
  const std::string text(reinterpret_cast<const char*>(good.data()), good.size());
  Bytes renamed = good;
  renamed[text.find("mop")] = std::byte{'t'};
  EXPECT_THAT([&] { decode_learner_reply(renamed); },
              testing::ThrowsMessage<Malformed>(
                  testing::HasSubstr("a network 'top' in the place of 'mop'")));
}

// Decoding one kind of message as another must not crash either; what comes out is the caller's to
// judge, since both are well formed.
TEST(Codec, AMessageOfAnotherKindIsMalformedOrAValue) {
  for_each_message([](const Bytes& bytes, const auto&) {
    const auto try_to = [&](auto decode) {
      try {
        decode(bytes);
      } catch (const Malformed&) {
      }
    };
    try_to(decode_header);
    try_to(decode_replay_request);
    try_to(decode_replay_reply);
    try_to(decode_learner_request);
    try_to(decode_learner_reply);
  });
}

TEST(CodecDeathTest, ValuesBeyondTheLimitsAreABugOfTheSender) {
  Header header;
  header.refusal = std::string(513, 'x');
  EXPECT_DEATH(encode(header), "513 bytes of text");
  Insert insert = insert_of(0);
  insert.open.actions.resize(1024 * 1024 + 1);
  EXPECT_DEATH(encode(ReplayRequest(insert)), "bytes in a field");
}

}  // namespace
}  // namespace corridor
