// SPDX-License-Identifier: Apache-2.0
#include "replay/replay_service.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "proto/base/failure.h"
#include "proto/base/random.h"
#include "proto/run/checkpoints.h"
#include "proto/run/metrics.h"
#include "proto/run/run_directory.h"
#include "proto/wire/codec.h"
#include "tests/replay/small_run.h"
#include "tests/support/batches.h"
#include "tests/support/temporary_directory.h"

namespace corridor::replay {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr ClientId kLearner{Role::kLearner, 0};
constexpr ClientId actor(std::uint32_t index) { return {Role::kActor, index}; }

template <typename Reply>
Reply reply_of(const Outcome& outcome) {
  if (const auto* refused = std::get_if<Refused>(&outcome)) {
    ADD_FAILURE() << "refused: " << refused->text;
    return {};
  }
  const auto* reply = std::get_if<ReplayReply>(&outcome);
  if (reply == nullptr || !std::holds_alternative<Reply>(*reply)) {
    ADD_FAILURE() << "another reply";
    return {};
  }
  return std::get<Reply>(*reply);
}

Batch batch_of(const Outcome& outcome) {
  return testing_support::decoded_batch(std::get<EncodedBatch>(outcome).body);
}

std::string refusal_of(const Outcome& outcome) {
  const auto* refused = std::get_if<Refused>(&outcome);
  return refused == nullptr ? "not refused" : refused->text;
}

void insert(ReplayService& service, std::uint64_t round, std::uint32_t index) {
  reply_of<Inserted>(service.handle(actor(index), chunk(round, index)));
}

double figure(const ReplayService& service, const std::string& name) {
  for (const auto& [key, value] : service.metrics()) {
    if (key == name) return value;
  }
  ADD_FAILURE() << "no figure " << name;
  return -1.0;
}

Opened open(ReplayService& service, std::uint64_t round) {
  EXPECT_TRUE(std::holds_alternative<Waiting>(service.handle(kLearner, OpenBlock{round})));
  const std::optional<Opened> opened = service.try_open();
  EXPECT_TRUE(opened.has_value()) << "block " << round;
  return opened.value_or(Opened{});
}

// A learner's block: all granted batches, new priorities one batch late.
void train(ReplayService& service, std::uint32_t batches, std::vector<Batch>& log) {
  Step step;
  step.importance_exponent = 0.5;
  for (std::uint32_t i = 0; i <= batches; ++i) {
    step.count = i < batches ? 8 : 0;
    Batch batch = batch_of(service.handle(kLearner, step));
    step.keys = batch.keys;
    step.priorities = batch.weights;
    log.push_back(std::move(batch));
  }
}

void run_blocks(ReplayService& service, std::uint64_t from, std::uint64_t to,
                std::vector<Batch>& log) {
  for (std::uint64_t round = from; round < to; ++round) {
    for (std::uint32_t index = 0; index < kActors; ++index) insert(service, round, index);
    train(service, open(service, round).batches, log);
  }
}

class ReplayServiceTest : public testing::Test {
 protected:
  // A checkpoint of the service, which has written those before into the same place.
  fs::path checkpoint(ReplayService& service, const std::string& place) const {
    fs::create_directories(directory_ / place);
    const Checkpoints checkpoints(directory_ / place);
    const std::optional<fs::path> previous = checkpoints.newest();
    const std::uint64_t round = previous ? checkpoint_round(*previous) + 1 : 0;
    write(service.snapshot(previous.value_or("")), checkpoints.begin(round), previous.value_or(""));
    checkpoints.commit(round, 2);
    return *checkpoints.newest();
  }

  // All that the service holds, however its rows are divided among files.
  TensorFile whole(ReplayService& service, const std::string& place) const {
    const fs::path directory = checkpoint(service, place);
    TensorFile all = read_checkpoint_file(directory, kReplayFile);
    std::vector<float> rows;
    std::size_t stride = 0;
    for (const RowsFile& file : rows_files(directory)) {
      const TensorFile part = read_checkpoint_file(directory, file.name());
      const auto& values = part.get<float>(kRowsTensor, file.name());
      rows.insert(rows.end(), values.begin(), values.end());
      stride = part.tensors.at(kRowsTensor).shape.at(1);
    }
    const std::size_t held = all.get<float>(kLeavesTensor, kReplayFile).size();
    rows.erase(rows.begin(), rows.end() - static_cast<std::ptrdiff_t>(held * stride));
    all.put(kRowsTensor, std::move(rows));
    return all;
  }

  // The answer once the checkpoint is complete, or the refusal.
  Outcome save(ReplayService& service, const fs::path& directory) const {
    while (true) {
      const Outcome outcome = service.handle(kLearner, Save{directory.string(), ""});
      const auto* reply = std::get_if<ReplayReply>(&outcome);
      if (reply == nullptr || std::get<Saved>(*reply).complete) return outcome;
    }
  }

  testing_support::TemporaryDirectory temporary_;
  fs::path directory_ = temporary_.path();
};

TEST_F(ReplayServiceTest, BatchesDependOnNoOrderOfArrival) {
  ReplayService in_order(small_config());
  std::vector<Batch> expected;
  run_blocks(in_order, 0, kRounds, expected);
  const TensorFile expected_state = whole(in_order, "in order");
  EXPECT_GT(expected.size(), 100U);

  for (std::uint64_t shuffle = 0; shuffle < 20; ++shuffle) {
    ReplayService service(small_config());
    std::vector<Batch> log;
    std::vector<std::uint64_t> sent(kActors);
    std::uint64_t draw = 0;
    for (std::uint64_t round = 0; round < kRounds; ++round) {
      ASSERT_TRUE(std::holds_alternative<Waiting>(service.handle(kLearner, OpenBlock{round})));
      std::optional<Opened> opened = service.try_open();
      while (!opened) {
        // Any actor, up to two rounds ahead of the last block.
        const auto index = static_cast<std::uint32_t>(
            random_below(kActors, shuffle, Purpose::kBootstrap, {draw++}));
        if (sent[index] < std::min(round + 2, kRounds)) insert(service, sent[index]++, index);
        opened = service.try_open();
      }
      train(service, opened->batches, log);
    }
    ASSERT_EQ(log, expected) << "order " << shuffle;
    ASSERT_TRUE(whole(service, std::to_string(shuffle)) == expected_state) << "order " << shuffle;
  }
}

TEST_F(ReplayServiceTest, ARestoredServiceContinuesWithTheSameBits) {
  for (std::uint64_t cut = 1; cut < kRounds; ++cut) {
    ReplayService service(small_config());
    std::vector<Batch> before;
    run_blocks(service, 0, cut, before);
    // A parked chunk is no part of the checkpoint.
    insert(service, cut, 1);
    const std::string place = std::to_string(cut);
    ReplayService restored(small_config());
    restored.load(checkpoint(service, place));
    EXPECT_EQ(reply_of<Joined>(restored.handle(actor(1), Join{})).next_round, cut);
    EXPECT_EQ(restored.metrics(), service.metrics());
    insert(service, cut, 0);
    insert(service, cut, 2);
    std::vector<Batch> expected;
    train(service, open(service, cut).batches, expected);
    run_blocks(service, cut + 1, kRounds, expected);
    std::vector<Batch> log;
    run_blocks(restored, cut, kRounds, log);
    ASSERT_EQ(log, expected) << "cut before round " << cut;
    // Both go on with the files of the cut.
    fs::copy(directory_ / place, directory_ / (place + " restored"), fs::copy_options::recursive);
    ASSERT_TRUE(whole(restored, place + " restored") == whole(service, place));
  }
}

TEST_F(ReplayServiceTest, ACheckpointWritesOnlyTheRowsSinceTheOneBefore) {
  ReplayService service(small_config());
  std::vector<Batch> log;
  std::set<std::string> before;
  for (std::uint64_t round = 0; round < kMopRounds; ++round) {
    run_blocks(service, round, round + 1, log);
    const fs::path directory = checkpoint(service, "x");
    std::set<std::string> now;
    std::size_t fresh = 0;
    for (const RowsFile& file : rows_files(directory)) {
      now.insert(file.name());
      fresh += !before.contains(file.name());
    }
    EXPECT_EQ(fresh, 1u) << "round " << round;
    before = now;
    ReplayService restored(small_config());
    EXPECT_NO_THROW(restored.load(directory));
  }
}

TEST_F(ReplayServiceTest, GrantsTheAskedRatio) {
  ReplayService service(small_config());
  std::uint64_t granted = 0;
  std::uint64_t inserted = 0;
  for (std::uint64_t round = 0; round < kMopRounds; ++round) {
    for (std::uint32_t index = 0; index < kActors; ++index) {
      inserted += chunk(round, index).priorities.size();
      insert(service, round, index);
    }
    const Opened opened = open(service, round);
    granted += opened.batches;
    EXPECT_EQ(figure(service, metric::kReplayInserted), inserted);
    EXPECT_EQ(figure(service, metric::kReplaySize), std::min<std::uint64_t>(inserted, 150));
    EXPECT_EQ(granted, inserted < 70 ? 0 : (inserted - 69) * 2 / 8);
  }
}

TEST_F(ReplayServiceTest, APhaseStartsAfreshButForItsKeys) {
  ReplayService service(small_config());
  std::vector<Batch> log;
  run_blocks(service, 0, kMopRounds, log);
  const std::vector<std::uint64_t> old_keys = log[log.size() - 2].keys;
  ASSERT_EQ(old_keys.size(), 8U);
  for (std::uint32_t index = 0; index < kActors; ++index) insert(service, kMopRounds, index);
  open(service, kMopRounds);
  EXPECT_EQ(figure(service, metric::kReplayInserted), figure(service, metric::kReplaySize));
  EXPECT_LT(figure(service, metric::kReplaySize), 80);
  EXPECT_EQ(figure(service, metric::kReplaySampled), 0);
  EXPECT_EQ(figure(service, metric::kStalePriorities), 0);

  const Batch batch =
      batch_of(service.handle(kLearner, Step{old_keys, std::vector<float>(8, 1e9F), 8, 0.4}));
  EXPECT_EQ(batch.observations, static_cast<std::uint32_t>(bp_shape(3).observations));
  EXPECT_GT(*std::min_element(batch.keys.begin(), batch.keys.end()),
            *std::max_element(old_keys.begin(), old_keys.end()));
  insert(service, kMopRounds + 1, 0);
  insert(service, kMopRounds + 1, 1);
  insert(service, kMopRounds + 1, 2);
  open(service, kMopRounds + 1);
  EXPECT_EQ(figure(service, metric::kStalePriorities), 8);
}

TEST_F(ReplayServiceTest, ARestartedActorGoesOnAfterItsLastChunkParkedOrNot) {
  ReplayService service(small_config());
  EXPECT_EQ(reply_of<Joined>(service.handle(actor(1), Join{})), (Joined{0, {}}));
  insert(service, 0, 1);
  EXPECT_EQ(reply_of<Joined>(service.handle(actor(1), Join{})), (Joined{1, chunk(0, 1).open}));
  EXPECT_EQ(reply_of<Joined>(service.handle(actor(2), Join{})), (Joined{0, {}}));
  EXPECT_EQ(reply_of<Joined>(service.handle(kLearner, Join{})), (Joined{0, {}}));
  insert(service, 0, 0);
  insert(service, 0, 2);
  insert(service, 1, 1);
  open(service, 0);
  EXPECT_EQ(reply_of<Joined>(service.handle(actor(1), Join{})), (Joined{2, chunk(1, 1).open}));
  EXPECT_EQ(reply_of<Joined>(service.handle(actor(2), Join{})), (Joined{1, chunk(0, 2).open}));
  EXPECT_EQ(reply_of<Joined>(service.handle(kLearner, Join{})), (Joined{1, {}}));

  ReplayService restored(small_config());
  restored.load(checkpoint(service, "x"));
  EXPECT_EQ(reply_of<Joined>(restored.handle(actor(1), Join{})), (Joined{1, chunk(0, 1).open}));
  EXPECT_EQ(reply_of<Joined>(restored.handle(actor(2), Join{})), (Joined{1, chunk(0, 2).open}));
}

TEST_F(ReplayServiceTest, NoEpisodeIsCarriedIntoTheNextPhase) {
  ReplayService service(small_config());
  std::vector<Batch> log;
  run_blocks(service, 0, kMopRounds, log);
  EXPECT_EQ(reply_of<Joined>(service.handle(actor(0), Join{})), (Joined{kMopRounds, {}}));
  insert(service, kMopRounds, 0);
  EXPECT_EQ(reply_of<Joined>(service.handle(actor(0), Join{})),
            (Joined{kMopRounds + 1, chunk(kMopRounds, 0).open}));
}

TEST_F(ReplayServiceTest, ABlockOpensWhenItsLastChunkComes) {
  ReplayService service(small_config());
  EXPECT_THAT(service.awaited(), IsEmpty());
  EXPECT_TRUE(std::holds_alternative<Waiting>(service.handle(kLearner, OpenBlock{0})));
  EXPECT_THAT(service.awaited(), ElementsAre(0, 1, 2));
  insert(service, 0, 2);
  insert(service, 0, 0);
  EXPECT_FALSE(service.try_open().has_value());
  EXPECT_THAT(service.awaited(), ElementsAre(1));
  // A learner that restarts asks again.
  EXPECT_TRUE(std::holds_alternative<Waiting>(service.handle(kLearner, OpenBlock{0})));
  EXPECT_THAT(refusal_of(service.handle(kLearner, Step{{}, {}, 1, 0.4})), HasSubstr("outside"));
  EXPECT_THAT(refusal_of(service.handle(kLearner, Save{directory_.string(), ""})),
              HasSubstr("open"));
  insert(service, 0, 1);
  EXPECT_TRUE(service.try_open().has_value());
  EXPECT_FALSE(service.try_open().has_value());
  EXPECT_THAT(service.awaited(), IsEmpty());
}

TEST_F(ReplayServiceTest, ChunksThatMakeNoSenseAreRefusedAndLeaveNoTrace) {
  ReplayService service(small_config());
  const auto refusal = [&](const auto& spoil) {
    Insert spoiled = chunk(0, 0);
    spoil(spoiled);
    return refusal_of(service.handle(actor(0), spoiled));
  };
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const float bad : {std::nanf(""), kInfinity, -kInfinity, -1e-6F}) {
    EXPECT_THAT(refusal([&](Insert& it) { it.priorities[3] = bad; }), HasSubstr("priorities"));
  }
  EXPECT_THAT(refusal([](Insert& it) { it.rows[5] = std::nanf(""); }), HasSubstr("NaN"));
  EXPECT_THAT(refusal([](Insert& it) { it.rows.pop_back(); }), HasSubstr("floats for"));
  EXPECT_THAT(refusal([](Insert& it) { it.priorities.pop_back(); }), HasSubstr("floats for"));
  EXPECT_THAT(refusal([](Insert& it) { ++it.observations; }), HasSubstr("floats for"));
  EXPECT_THAT(refusal([](Insert& it) { it = chunk(1, 0); }), HasSubstr("next is round 0"));
  EXPECT_THAT(refusal([](Insert& it) { it.round = kRounds; }), HasSubstr("a run of 10 rounds"));
  // Rows of the other phase.
  EXPECT_THAT(refusal([](Insert& it) { it.round = kMopRounds; }), HasSubstr("floats for"));
  EXPECT_EQ(reply_of<Joined>(service.handle(actor(0), Join{})), (Joined{0, {}}));

  insert(service, 0, 0);
  insert(service, 1, 0);
  EXPECT_THAT(refusal_of(service.handle(actor(0), chunk(2, 0))), HasSubstr("before round 0"));
}

TEST_F(ReplayServiceTest, StepsThatMakeNoSenseAreRefusedAndLeaveNoTrace) {
  ReplayService service(small_config());
  ReplayService untouched(small_config());
  std::vector<Batch> log;
  run_blocks(service, 0, 3, log);
  run_blocks(untouched, 0, 3, log);
  const auto refusal = [&](Step step) { return refusal_of(service.handle(kLearner, step)); };
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const double nan = std::nan("");
  for (const float bad : {std::nanf(""), kInfinity, -1.0F}) {
    EXPECT_THAT(refusal({{100, 101}, {1.0F, bad}, 8, 0.4}), HasSubstr("priorities"));
  }
  EXPECT_THAT(refusal({{100, UINT64_MAX}, {1.0F, 1.0F}, 8, 0.4}), HasSubstr("for key"));
  EXPECT_THAT(refusal({{100}, {1.0F, 1.0F}, 8, 0.4}), HasSubstr("1 keys, 2 priorities"));
  EXPECT_THAT(refusal({{100}, {1.0F}, UINT32_MAX, 0.4}), HasSubstr("more than a message holds"));
  EXPECT_THAT(refusal({{100}, {1.0F}, 8, nan}), HasSubstr("exponent"));
  EXPECT_THAT(refusal({{100}, {1.0F}, 8, -0.1}), HasSubstr("exponent"));
  EXPECT_THAT(refusal({{100}, {1.0F}, 8, 1e300}), HasSubstr("exponent"));
  EXPECT_TRUE(whole(service, "service") == whole(untouched, "untouched"));
}

TEST_F(ReplayServiceTest, SpoiledMessagesAreRefusedOrAnsweredButEndNothing) {
  ReplayService service(small_config());
  std::vector<Batch> log;
  run_blocks(service, 0, 3, log);
  const Step step{log.front().keys, log.front().weights, 8, 0.4};
  const std::vector<ReplayRequest> requests{Join{}, chunk(3, 0), OpenBlock{3}, step};
  std::size_t answered = 0;
  std::size_t refused = 0;
  std::size_t malformed = 0;
  for (std::uint64_t attempt = 0; attempt < 20'000; ++attempt) {
    const auto draw = [&](std::uint64_t bound, std::uint64_t index) {
      return random_below(bound, 9, Purpose::kBootstrap, {attempt, index});
    };
    const ReplayRequest& request = requests[attempt % requests.size()];
    Bytes bytes = encode(request);
    // The numbers lie in front of the payload.
    const std::uint64_t reach =
        draw(2, 0) == 0 ? std::min<std::size_t>(bytes.size(), 96) : bytes.size();
    bytes[draw(reach, 1)] ^= static_cast<std::byte>(1U << draw(8, 2));
    try {
      ReplayRequest spoiled = decode_replay_request(bytes);
      if (std::holds_alternative<Save>(spoiled)) continue;
      const ClientId client = std::holds_alternative<Insert>(request) ? actor(0) : kLearner;
      const Outcome outcome = service.handle(client, std::move(spoiled));
      if (const auto* reply = std::get_if<ReplayReply>(&outcome)) encode(*reply);
      (std::holds_alternative<Refused>(outcome) ? refused : answered) += 1;
    } catch (const Malformed&) {
      ++malformed;
    }
    if (!service.awaited().empty()) {
      // Back into the open block.
      service = ReplayService(small_config());
      run_blocks(service, 0, 3, log);
    }
  }
  EXPECT_GT(answered, 1000U);
  EXPECT_GT(refused, 1000U);
  EXPECT_GT(malformed, 1000U);
}

TEST_F(ReplayServiceTest, ClientsOutsideTheirRoleAreRefused) {
  ReplayService service(small_config());
  EXPECT_THAT(refusal_of(service.handle(actor(3), Join{})), HasSubstr("run.actors"));
  EXPECT_THAT(refusal_of(service.handle(actor(3), chunk(0, 0))), HasSubstr("run.actors"));
  EXPECT_THAT(refusal_of(service.handle({Role::kLearner, 1}, Join{})), HasSubstr("1 learner"));
  EXPECT_THAT(refusal_of(service.handle(actor(0), OpenBlock{0})), HasSubstr("an actor"));
  EXPECT_THAT(refusal_of(service.handle(actor(0), Step{})), HasSubstr("an actor"));
  EXPECT_THAT(refusal_of(service.handle(actor(0), Save{"/tmp", ""})), HasSubstr("an actor"));
  EXPECT_THAT(refusal_of(service.handle(kLearner, chunk(0, 0))), HasSubstr("a learner"));
}

TEST_F(ReplayServiceTest, BlocksOpenInTheirOrderUpToTheLast) {
  ReplayService service(small_config());
  EXPECT_THAT(refusal_of(service.handle(kLearner, OpenBlock{1})), HasSubstr("the next is block 0"));
  std::vector<Batch> log;
  run_blocks(service, 0, kRounds, log);
  EXPECT_THAT(refusal_of(service.handle(kLearner, OpenBlock{kRounds})),
              HasSubstr("block 10 of 10"));
  EXPECT_THAT(refusal_of(service.handle(kLearner, OpenBlock{3})), HasSubstr("block 3 wanted"));
}

TEST_F(ReplayServiceTest, ASaveEndsTheBlockAndFailsByARefusal) {
  ReplayService service(small_config());
  std::vector<Batch> log;
  run_blocks(service, 0, 3, log);
  EXPECT_THAT(refusal_of(service.handle(kLearner, Save{"", ""})), HasSubstr("no directory"));
  EXPECT_THAT(refusal_of(save(service, directory_ / "none")),
              HasSubstr((directory_ / "none").string()));
  EXPECT_TRUE(reply_of<Saved>(save(service, directory_)).complete);
  EXPECT_THAT(refusal_of(service.handle(kLearner, Step{{}, {}, 8, 0.4})), HasSubstr("outside"));
}

TEST_F(ReplayServiceTest, ACheckpointOfAnotherConfigurationIsAFailure) {
  ReplayService service(small_config());
  std::vector<Batch> log;
  run_blocks(service, 0, kRounds, log);
  const fs::path place = checkpoint(service, "x");
  RunConfig more_actors = small_config();
  more_actors.run.actors = 4;
  EXPECT_THROW(ReplayService(more_actors).load(place), Failure);
  RunConfig shorter = small_config();
  shorter.dqn[1].steps = 60;
  EXPECT_THROW(ReplayService(shorter).load(place), Failure);
  EXPECT_THROW(ReplayService(small_config()).load(directory_ / "none"), Failure);
}

}  // namespace
}  // namespace corridor::replay
