#include "learner/training.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "learner/torch_q_network.h"
#include "proto/base/failure.h"
#include "proto/base/json.h"
#include "proto/run/tensor_file.h"
#include "tests/learner/small_run.h"
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
  EXPECT_NE(run.weights.at(4).mop, start.published[0].mop);
  EXPECT_EQ(run.weights.at(4).bp, start.published[0].bp);
  EXPECT_NE(run.weights.at(9).bp, start.published[0].bp);
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
  while (last.weights.at(first).mop == last.weights.at(0).mop) ++first;
  const std::vector<float>& start = last.weights.at(0).mop;
  const std::vector<float>& trained = last.weights.at(first).mop;
  const std::vector<float>& driven = mean.weights.at(first).mop;
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
  const std::vector<float>& expected = run.weights.at(schedule.weights_version(best_round)).mop;
  for (std::uint64_t version = kMopRounds; version <= 9; ++version) {
    EXPECT_EQ(run.weights.at(version).mop, expected) << version;
  }
  EXPECT_EQ(place.newest(kLearnerFile).get<float>("mop", "file"), expected);
}

TEST(Training, GivesTheSameBitsInEachRun) {
  Place one, two;
  RunConfig slowed = small_config();
  slowed.run.delay_ms_max = 5.0;
  SmallRun(small_config(), one.directory).run();
  SmallRun(slowed, two.directory).run();
  expect_same_end(one, two);
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
    replay::serve(replay_socket, service, metrics, small_config(), [&] { return end.load(); });
  });
  Client client(address, "replay server", {kRunId, Role::kLearner, 0, 1}, {});
  TimeAccount time;
  ReplayClient replay(client, time, [] {});
  MetricsWriter metrics(place.directory.metrics(kLearnerName));
  Training training(small_config(),
                    {place.directory, replay, publisher, metrics, time, [] { return false; }},
                    place.state());
  try {
    training.run();
    ADD_FAILURE() << "no Failure";
  } catch (const Failure& failure) {
    EXPECT_THAT(failure.what(), HasSubstr("round 0, the learner with round 11"));
  }
  end = true;
  replay_server.join();
}

}  // namespace
}  // namespace corridor::learner
