// SPDX-License-Identifier: Apache-2.0
#include "actor/rounds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <set>

#include "proto/base/failure.h"
#include "proto/run/metrics.h"
#include "proto/settings/schedule.h"
#include "proto/system/files.h"
#include "proto/wire/codec.h"
#include "proto/wire/connect.h"
#include "tests/support/failure_of.h"
#include "tests/support/fake_world.h"
#include "tests/support/scripted_server.h"
#include "tests/support/temporary_directory.h"

namespace corridor::actor {
namespace {

using testing::ElementsAreArray;
using testing::HasSubstr;
using testing_support::ScriptedServer;

// Five rounds of each phase; every second one selects.
RunConfig small_config() {
  RunConfig config;
  config.run.actors = 1;
  config.run.seed = 3;
  config.simulation.episode_steps = 30;
  config.schedule.steps_per_round = 20;
  config.schedule.selection_every_steps = 40;
  config.schedule.selection_episodes = 1;
  for (DqnSettings& dqn : config.dqn) {
    dqn.hidden = {4};
    dqn.steps = 100;
  }
  return config;
}

// An actor between two servers that answer everything, or what a test has them answer.
class Rounds : public testing::Test {
 protected:
  void run() {
    ScriptedServer<ReplayRequest> replay_server(addresses_.replay, run_id_, decode_replay_request,
                                                answers_of_replay);
    ScriptedServer<LearnerRequest> learner_server(addresses_.learner, run_id_,
                                                  decode_learner_request, answers_of_learner);
    testing_support::FakeWorld world(config_);
    TimeAccount time;
    train(config_, directory_, {run_id_, Role::kActor, 0, ++incarnation_}, world, time,
          [this] { ++delays; });
    asked_of_replay = replay_server.end();
    asked_of_learner = learner_server.end();
  }
  Weights weights(std::uint64_t version) const {
    Weights result{version, {}};
    for (const NamedNetwork& network : kNetworks) {
      result.networks[network.id].assign(config_.parameters(network.id), 0.01f);
    }
    return result;
  }
  std::vector<Insert> chunks() const {
    std::vector<Insert> result;
    for (const ReplayRequest& request : asked_of_replay) {
      if (const auto* insert = std::get_if<Insert>(&request)) result.push_back(*insert);
    }
    return result;
  }

  const RunConfig config_ = small_config();
  const Schedule schedule_{config_};

  Joined joined{0, {}};
  ScriptedServer<ReplayRequest>::Script answers_of_replay =
      [this](const ReplayRequest& request) -> std::optional<Body> {
    if (std::holds_alternative<Join>(request)) return encode(ReplayReply(joined));
    return encode(ReplayReply(Inserted{}));
  };
  ScriptedServer<LearnerRequest>::Script answers_of_learner =
      [this](const LearnerRequest& request) -> std::optional<Body> {
    if (const auto* wanted = std::get_if<WeightsWanted>(&request)) {
      return encode(LearnerReply(weights(wanted->version)));
    }
    return encode(LearnerReply(Noted{}));
  };
  std::vector<ReplayRequest> asked_of_replay;
  std::vector<LearnerRequest> asked_of_learner;
  std::uint64_t delays = 0;

  testing_support::TemporaryDirectory temporary_;
  const RunDirectory directory_ = RunDirectory::create(temporary_.path() / "run");

 private:
  const std::string run_id_ = fmt::format("{:032x}", getpid());
  const Addresses addresses_ = addresses(config_.run, run_id_, directory_.root());
  std::uint64_t incarnation_ = 0;
};

TEST_F(Rounds, EveryRoundIsDrivenOnceInOrderWithTheWeightsOfItsSchedule) {
  run();
  const std::vector<Insert> sent = chunks();
  ASSERT_EQ(sent.size(), schedule_.rounds());
  for (std::uint64_t round = 0; round < sent.size(); ++round) EXPECT_EQ(sent[round].round, round);
  EXPECT_EQ(delays, schedule_.rounds());

  std::set<std::uint64_t> versions;
  std::vector<std::uint64_t> selections;
  for (std::uint64_t round = 0; round < schedule_.rounds(); ++round) {
    versions.insert(schedule_.weights_version(round));
    if (schedule_.selects_in(round)) selections.push_back(round);
  }
  std::vector<std::uint64_t> wanted, selected;
  for (const LearnerRequest& request : asked_of_learner) {
    if (const auto* weights = std::get_if<WeightsWanted>(&request)) {
      wanted.push_back(weights->version);
    } else {
      selected.push_back(std::get<SelectionOutcome>(request).round);
    }
  }
  EXPECT_THAT(wanted, ElementsAreArray(versions));  // each once, ascending
  EXPECT_THAT(selected, ElementsAreArray(selections));
}

TEST_F(Rounds, OneThatJoinsLaterSendsTheSameChunksFromThereOn) {
  run();
  const std::vector<Insert> all = chunks();
  for (const std::uint64_t first : {1, 3, 4, 5, 8}) {
    // No episode is carried over into the next phase.
    const bool begins_phase = first == schedule_.first_round(Phase::kBp);
    joined = {first, begins_phase ? OpenEpisode{} : all[first - 1].open};
    run();
    EXPECT_THAT(chunks(), ElementsAreArray(all.begin() + static_cast<long>(first), all.end()))
        << first;
  }
}

TEST_F(Rounds, ReportsEachPhasesEnd) {
  run();
  const std::string metrics = read_file(directory_.metrics(actor_name(0)));
  EXPECT_THAT(metrics, HasSubstr("\"MoP\""));
  EXPECT_THAT(metrics, HasSubstr("\"BP\""));
  EXPECT_THAT(metrics, HasSubstr(metric::kRewardPer1000));
}

TEST_F(Rounds, WeightsThatWereNotAskedForAreRefused) {
  const std::string text = "which are not those asked for: is it of another configuration?";
  answers_of_learner = [this](const LearnerRequest& request) -> std::optional<Body> {
    return encode(LearnerReply(weights(std::get<WeightsWanted>(request).version + 1)));
  };
  EXPECT_THAT(failure_of([&] { run(); }), HasSubstr(text));
  answers_of_learner = [this](const LearnerRequest&) -> std::optional<Body> {
    Weights shorter = weights(0);
    shorter.networks[NetworkId::kBp].pop_back();
    return encode(LearnerReply(shorter));
  };
  EXPECT_THAT(failure_of([&] { run(); }), HasSubstr(text));
}

TEST_F(Rounds, AnAnswerToAnotherQuestionIsRefused) {
  answers_of_replay = [](const ReplayRequest&) { return Body(encode(ReplayReply(Inserted{}))); };
  EXPECT_THAT(failure_of([&] { run(); }), HasSubstr("the replay server answered another question"));
}

}  // namespace
}  // namespace corridor::actor
