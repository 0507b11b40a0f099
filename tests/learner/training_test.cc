// SPDX-License-Identifier: Apache-2.0
#include "learner/training.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "proto/base/json.h"
#include "proto/run/checkpoints.h"
#include "proto/run/metrics.h"
#include "proto/run/tensor_file.h"
#include "tests/learner/scripted_server.h"
#include "tests/learner/small_run.h"
#include "tests/support/failure_of.h"
#include "tests/support/manual_clock.h"
#include "tests/support/temporary_directory.h"

namespace corridor::learner {
namespace {

using testing::AnyOf;
using testing::HasSubstr;
using testing::Key;
using testing::UnorderedElementsAre;

struct Place {
  testing_support::TemporaryDirectory temporary;
  RunDirectory directory = RunDirectory::create(temporary.path() / "run");

  std::filesystem::path newest() const {
    return Checkpoints(directory.checkpoints()).newest().value();
  }
  TensorFile newest(const std::string& file) const { return read_checkpoint_file(newest(), file); }
  // The replay's, however its rows are divided among files.
  TensorFile replay() const {
    TensorFile all = newest(kReplayFile);
    std::vector<float> rows;
    for (const RowsFile& file : rows_files(newest())) {
      const TensorFile part = newest(file.name());
      const auto& values = part.get<float>(kRowsTensor, "replay");
      rows.insert(rows.end(), values.begin(), values.end());
    }
    all.put(kRowsTensor, std::move(rows));
    return all;
  }
  LearnerState state() const { return load_state(small_config(), directory); }
};

void expect_same_end(const Place& a, const Place& b) {
  EXPECT_EQ(a.newest().filename(), b.newest().filename());
  EXPECT_TRUE(a.newest(kLearnerFile) == b.newest(kLearnerFile));
  EXPECT_TRUE(a.replay() == b.replay());
}

TEST(Training, TrainsBothPhasesToTheEnd) {
  Place place;
  SmallRun run(small_config(), place.directory);
  EXPECT_TRUE(run.run());

  const LearnerState end = place.state();
  EXPECT_EQ(end.next_round, kMopRounds + kBpRounds);
  EXPECT_GT(end.td.updates, 10u);
  // The actors got what they asked for: the versions of Schedule::weights_version.
  EXPECT_THAT(run.weights, UnorderedElementsAre(Key(0), Key(1), Key(2), Key(3), Key(4), Key(6),
                                                Key(7), Key(8), Key(9)));
  const LearnerState start = initial_state(small_config());
  EXPECT_EQ(run.weights.at(0), start.published[0]);
  EXPECT_NE(run.weights.at(4).networks[Phase::kMop], start.published[0].networks[Phase::kMop]);
  EXPECT_EQ(run.weights.at(4).networks[Phase::kBp], start.published[0].networks[Phase::kBp]);
  EXPECT_NE(run.weights.at(9).networks[Phase::kBp], start.published[0].networks[Phase::kBp]);
}

TEST(RunningAverage, ForgetsAnEthInEachWindowHoweverTheUpdatesAreDivided) {
  const std::vector<float> newest = {1.0f, -2.0f};
  std::vector<float> average = {0.0f, 0.0f};
  for (int block = 0; block < 5; ++block) average = running_average(average, newest, 20, 100);
  const float part = 1.0f - std::exp(-1.0f);
  EXPECT_NEAR(average[0], part, 1e-6);
  EXPECT_NEAR(average[1], -2.0f * part, 1e-6);
  EXPECT_EQ(running_average(average, newest, 0, 100), average);
  EXPECT_EQ(running_average(average, newest, 1, 0), newest);
}

TEST(Training, PublishesTheRunningAverageOfWhatItTrains) {
  Place plain, averaged;
  RunConfig config = small_config();
  config.dqn[0].averaging_updates = 0;
  SmallRun last(config, plain.directory);
  last.stop_at_version = 4;
  last.run();
  SmallRun mean(small_config(), averaged.directory);
  mean.stop_at_version = 4;
  mean.run();
  // The chunks follow the weights that drive: the first version with updates is comparable.
  std::uint64_t first = 1;
  while (last.weights.at(first).networks[Phase::kMop] == last.weights.at(0).networks[Phase::kMop])
    ++first;
  const std::vector<float>& start = last.weights.at(0).networks[Phase::kMop];
  const std::vector<float>& trained = last.weights.at(first).networks[Phase::kMop];
  const std::vector<float>& driven = mean.weights.at(first).networks[Phase::kMop];
  double moved = 0.0, moved_in_training = 0.0;
  for (std::size_t i = 0; i < start.size(); ++i) {
    moved += std::abs(driven[i] - start[i]);
    moved_in_training += std::abs(trained[i] - start[i]);
  }
  EXPECT_GT(moved, 0.0);
  EXPECT_LT(moved, moved_in_training);
}

TEST(Training, FreezesTheBestMopForTheBpsPhase) {
  Place place;
  const RunConfig config = small_config();
  const Schedule schedule(config);
  SmallRun run(config, place.directory);
  run.run();
  std::uint64_t best_round = 0;
  double best = -1e9;
  for (std::uint64_t round = 0; round < kMopRounds; ++round) {
    if (!schedule.selects_in(round)) continue;
    double reward = 0.0;
    for (std::uint32_t actor = 0; actor < kActors; ++actor) {
      reward += made_up_outcome(round, actor).reward;  // collisions are the same in each round
    }
    if (reward > best) best_round = round;
    best = std::max(best, reward);
  }
  const std::vector<float>& expected =
      run.weights.at(schedule.weights_version(best_round)).networks[Phase::kMop];
  for (std::uint64_t version = kMopRounds; version <= 9; ++version) {
    EXPECT_EQ(run.weights.at(version).networks[Phase::kMop], expected) << version;
  }
  EXPECT_EQ(place.newest(kLearnerFile).get<float>("mop", "file"), expected);
}

// `value` is at least so much.
void wait_for(const std::atomic<std::uint64_t>& value, std::uint64_t least) {
  for (std::uint64_t seen = value; seen < least; seen = value) value.wait(seen);
}

TEST(Training, GivesTheSameBitsHoweverLateTheChunksComeAndInWhichOrder) {
  Place undisturbed;
  SmallRun(small_config(), undisturbed.directory).run();
  for (std::uint32_t last = 0; last < kActors; ++last) {
    Place late;
    SmallRun run(small_config(), late.directory);
    std::atomic<std::uint64_t> begun = 0;   // rounds, by the learner, which then waits
    std::atomic<std::uint64_t> others = 0;  // chunks that the other actor sends
    const auto count = [](std::atomic<std::uint64_t>& counter) {
      ++counter;
      counter.notify_all();
    };
    run.delay = [&] { count(begun); };
    run.before_chunk = [&](std::uint64_t round, std::uint32_t actor) {
      wait_for(begun, round + 1);
      if (actor == last) {
        wait_for(others, round + 1);
      } else {
        count(others);
      }
    };
    EXPECT_TRUE(run.run());
    expect_same_end(undisturbed, late);
  }
}

TEST(Training, GivesUpOnActorsThatHangInABlockOrInAnEvaluationAfterHalfAnHour) {
  const auto failure = [](std::uint64_t round) {
    Place place;
    SmallRun run(small_config(), place.directory);
    run.actors_hang = true;
    run.actors_end_at = round;
    return failure_of([&] { run.run(); });
  };
  EXPECT_THAT(failure(4), HasSubstr("round 4: chunks of actors are missing for 30 min"));
  EXPECT_THAT(failure(3),
              HasSubstr("round 3: actors 0, 1 have not reported their evaluation in 30 min"));
}

TEST(Training, GivesUpOnACheckpointThatIsNotCompleteAfterHalfAnHour) {
  Place place;
  ScriptedServer server([](const ReplayRequest& request) -> std::optional<Body> {
    if (std::holds_alternative<Join>(request)) return encode(Joined{});
    if (std::holds_alternative<OpenBlock>(request)) return encode(Opened{0});
    return encode(Saved{false});
  });
  Server socket(fresh_address("learner"), kRunId);
  Publisher publisher(socket, kActors);
  Client client(server.address(), "replay server", {kRunId, Role::kLearner, 0, 1}, {});
  TimeAccount account;
  ReplayClient replay(client, account, [] {});
  MetricsWriter metrics(place.directory.metrics("learner"));
  // Asked to stop after the first block; from then on a minute passes at each look.
  int rounds = 0;
  testing_support::ManualClock time;
  const Clock minutes = [&] {
    if (rounds > 1) time.advance(std::chrono::minutes(1));
    return time.now();
  };
  Training training(small_config(),
                    {.directory = place.directory,
                     .replay = replay,
                     .publisher = publisher,
                     .metrics = metrics,
                     .time = account,
                     .stop_requested = [&] { return rounds > 1; },
                     .delay = [&] { ++rounds; },
                     .clock = minutes},
                    initial_state(small_config()));
  EXPECT_THAT(failure_of([&] { training.run(); }),
              HasSubstr("a checkpoint is not complete after 30 min"));
}

TEST(Training, GoesOnBitForBitAfterAStopInAnyRound) {
  Place whole;
  SmallRun(small_config(), whole.directory).run();
  for (const std::uint64_t version : {1, 4, 6, 9}) {
    Place stopped;
    {
      SmallRun first(small_config(), stopped.directory);
      first.stop_at_version = version;
      first.run();
    }
    EXPECT_TRUE(SmallRun(small_config(), stopped.directory).run());
    expect_same_end(whole, stopped);
  }
}

TEST(Training, TakesACheckpointOfWhatIsDoneWhenAskedToStopBetweenBlocks) {
  Place place;
  SmallRun run(small_config(), place.directory);
  run.stop_at_version = 3;
  EXPECT_FALSE(run.run());
  const LearnerState state = place.state();
  EXPECT_GE(state.next_round, 3u);
  EXPECT_LT(state.next_round, kMopRounds + kBpRounds);
}

TEST(Training, StopsWhenTheActorsHaveGone) {
  Place whole, left;
  SmallRun(small_config(), whole.directory).run();
  SmallRun run(small_config(), left.directory);
  run.actors_end_at = 4;  // not a round of selection
  EXPECT_FALSE(run.run());
  // The scheduled one, unless the learner saw the request before it asked for block 4, or stopped
  // before that one was whole on the disk.
  EXPECT_THAT(left.state().next_round, AnyOf(0u, 3u, 4u));
  EXPECT_TRUE(SmallRun(small_config(), left.directory).run());
  expect_same_end(whole, left);
}

TEST(Training, DoesNothingMoreWhenAllIsDone) {
  Place place;
  SmallRun(small_config(), place.directory).run();
  const LearnerState end = place.state();
  EXPECT_TRUE(SmallRun(small_config(), place.directory).run());
  EXPECT_EQ(place.state(), end);
}

TEST(Training, WritesMetricsWithTheSelectionsScore) {
  Place place;
  SmallRun(small_config(), place.directory).run();
  std::ifstream file(place.directory.metrics(kLearnerName));
  std::string line;
  int scores = 0;
  while (std::getline(file, line)) {
    const Json values = Json::parse(line);
    if (!values.contains(metric::kGreedyScore)) continue;
    ++scores;
    const auto round = values["round"].get<std::uint64_t>();
    const double reward =
        made_up_outcome(round, 0).reward + made_up_outcome(round, 1).reward;  // in 2000 steps
    EXPECT_NEAR(values[metric::kGreedyRewardPer1000].get<double>(), reward / 2.0, 1e-9);
    EXPECT_NEAR(values[metric::kGreedyCollisionsPer1000].get<double>(), 0.5, 1e-9);
    EXPECT_NEAR(values[metric::kGreedyScore].get<double>(), reward / 2.0 - 25.0, 1e-9);
    EXPECT_EQ(values["phase"], round < kMopRounds ? "MoP" : "BP");
  }
  EXPECT_EQ(scores, 6);  // rounds 1, 3, 5 and 7, 9, 10
}

TEST(Training, RefusesAReplayServerAtAnotherRound) {
  Place place;
  SmallRun(small_config(), place.directory).run();
  Server server(fresh_address("learner"), kRunId);
  Publisher publisher(server, kActors);
  const std::string address = fresh_address("replay");
  std::atomic<bool> end = false;
  std::thread replay_server([&] {
    replay::ReplayService service(small_config());  // at the start, without the checkpoint
    MetricsWriter metrics(place.temporary.path() / "replay.jsonl");
    Server replay_socket(address, kRunId);
    replay::serve(replay_socket, service, metrics, small_config(), {[&] { return end.load(); }});
  });
  Client client(address, "replay server", {kRunId, Role::kLearner, 0, 1}, {});
  TimeAccount time;
  ReplayClient replay(client, time, [] {});
  MetricsWriter metrics(place.directory.metrics(kLearnerName));
  Training training(small_config(),
                    {place.directory, replay, publisher, metrics, time, [] { return false; }},
                    place.state());
  EXPECT_THAT(failure_of([&] { training.run(); }), HasSubstr("round 0, the learner with round 11"));
  end = true;
  replay_server.join();
}

}  // namespace
}  // namespace corridor::learner
