// SPDX-License-Identifier: Apache-2.0
// A whole small run in one process, for the learner's tests: both phases in 11 rounds, the real
// replay server and made-up actors on threads, talking through real sockets.
#pragma once

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "learner/training.h"
#include "proto/base/failure.h"
#include "proto/base/hash.h"
#include "proto/base/random.h"
#include "proto/run/run_directory.h"
#include "proto/wire/codec.h"
#include "proto/wire/endpoint.h"
#include "replay/replay_service.h"
#include "replay/serve.h"
#include "tests/support/manual_clock.h"

namespace corridor::learner {

inline constexpr const char* kRunId = "00112233445566778899aabbccddeeff";
inline constexpr std::uint64_t kMopRounds = 6;
inline constexpr std::uint64_t kBpRounds = 5;
inline constexpr int kActors = 2;
inline constexpr int kRowsPerChunk = 8;
inline constexpr Duration kStopPatience = std::chrono::minutes(2);

inline RunConfig small_config() {
  RunConfig config;
  config.run.seed = 11;
  config.run.actors = kActors;
  config.schedule.steps_per_round = kRowsPerChunk;
  config.schedule.selection_every_steps = 2 * kActors * kRowsPerChunk;
  config.schedule.checkpoint_every_steps = 3 * kActors * kRowsPerChunk;
  config.schedule.checkpoints_kept = 100;
  for (DqnSettings& dqn : config.dqn) {
    dqn.hidden = {8};
    dqn.batch_size = 8;
    dqn.minimum_size = 24;
    dqn.samples_per_insert = 4.0;
    dqn.target_copy_updates = 5;
    dqn.learning_rate = 1e-2;
  }
  config.dqn[0].averaging_updates = 10;
  config.dqn[1].averaging_updates = 0;
  config.dqn[0].steps = kMopRounds * kActors * kRowsPerChunk;
  config.dqn[1].steps = kBpRounds * kActors * kRowsPerChunk;
  config.dqn[1].dueling = true;
  return config;
}

inline std::string fresh_address(const char* name) {
  static std::atomic<int> number = 0;
  return fmt::format("ipc://@corridor-learner-test-{}-{}-{}", getpid(), name, ++number);
}

inline std::uint64_t fresh_incarnation() {
  static std::atomic<std::uint64_t> number = 0;
  return ++number;
}

// An actor's part, without a road: rows and outcomes are functions of (round, actor, weights).
inline Insert made_up_chunk(const RunConfig& config, std::uint64_t round, std::uint32_t actor,
                            const Weights& weights) {
  const Phase phase = Schedule(config).phase_of(round);
  const PlannerShape shape = config.shape(phase);
  const float taste = weights.networks[phase][0];
  Insert chunk;
  chunk.round = round;
  chunk.observations = static_cast<std::uint32_t>(shape.observations);
  chunk.open = {round, {}};
  std::uint64_t draw = 0;
  const auto unit = [&] {
    return static_cast<float>(random_unit(7, Purpose::kBootstrap, {round, actor, draw++}));
  };
  for (int i = 0; i < kRowsPerChunk; ++i) {
    for (int j = 0; j < 2 * shape.observations; ++j) chunk.rows.push_back(unit());
    chunk.rows.push_back(static_cast<float>(i % shape.actions));
    chunk.rows.push_back(unit() + taste);
    chunk.rows.push_back(i == 3 ? 0.0f : 0.9f);
    chunk.rows.push_back(i == 3 ? 1.0f : 0.0f);
    chunk.rows.push_back(i == 3 ? 0.0f : 0.8f);
    chunk.priorities.push_back(unit());
  }
  return chunk;
}

inline SelectionOutcome made_up_outcome(std::uint64_t round, std::uint32_t actor) {
  return {round, 8, 1000, 100.0 * random_unit(5, Purpose::kBootstrap, {round, actor}), actor};
}

class SmallRun {
 public:
  SmallRun(RunConfig config, const RunDirectory& directory)
      : config_(std::move(config)), schedule_(config_), directory_(directory) {}

  // Round of which actors send nothing: once its block is next, they go, and the learner is asked
  // to stop, or, if they hang, is not. From then on minutes pass for it whenever it looks whether
  // it is; before, no time does.
  std::uint64_t actors_end_at = UINT64_MAX;
  bool actors_hang = false;
  // Asks the learner to stop once an actor has got this version.
  std::uint64_t stop_at_version = UINT64_MAX;

  // The learner's, before each round.
  TestDelay delay = [] {};
  // An actor's, before it sends a round's chunk.
  std::function<void(std::uint64_t round, std::uint32_t actor)> before_chunk = [](std::uint64_t,
                                                                                  std::uint32_t) {};

  // From the newest checkpoint on; what Training::run returns. Throws what any thread has thrown.
  bool run() {
    stop_learner_ = false;
    end_ = false;
    const std::string replay_address = fresh_address("replay");
    const std::string learner_address = fresh_address("learner");
    Server server(learner_address, kRunId);
    std::vector<std::thread> threads;
    threads.emplace_back([&] { guarded([&] { serve_replay(replay_address); }); });
    for (std::uint32_t actor = 0; actor < kActors; ++actor) {
      threads.emplace_back(
          [&, actor] { guarded([&] { act(actor, replay_address, learner_address); }); });
    }
    bool done = false;
    guarded([&] { done = learn(replay_address, server); });
    end_ = true;
    for (std::thread& thread : threads) thread.join();
    if (!error_.empty()) throw Failure(error_);
    return done;
  }

  // Weights by version, as the actors got them.
  std::map<std::uint64_t, Weights> weights;

 private:
  void guarded(const std::function<void()>& body) {
    try {
      body();
    } catch (const std::exception& error) {
      const std::lock_guard lock(mutex_);
      if (error_.empty() && !end_) error_ = error.what();
      stop_learner_ = true;
    }
  }

  bool learn(const std::string& replay_address, Server& server) {
    MetricsWriter metrics(directory_.metrics(kLearnerName));
    Publisher publisher(server, kActors);
    Client client(replay_address, "replay server", {kRunId, Role::kLearner, 0, fresh_incarnation()},
                  {});
    TimeAccount time;
    ReplayClient replay(client, time, [&] { publisher.service(Duration::zero()); });
    const auto stop = [&] {
      if (minutes_pass_) clock_.advance(std::chrono::minutes(1));
      return stop_learner_.load();
    };
    Training training(
        config_,
        {directory_, replay, publisher, metrics, time, stop, kStopPatience, delay, clock_.clock()},
        load_state(config_, directory_));
    return training.run();
  }

  void serve_replay(const std::string& address) {
    replay::ReplayService service(config_);
    if (const auto checkpoint = Checkpoints(directory_.checkpoints()).newest())
      service.load(*checkpoint);
    MetricsWriter metrics(directory_.metrics(kReplayName));
    Server server(address, kRunId);
    replay::serve(server, service, metrics, config_, {[&] { return end_.load(); }});
  }

  // Nothing at the end of the run.
  std::optional<Body> answer(Client& client) {
    while (!end_) {
      if (auto body = client.receive(Duration{5})) return body;
    }
    return std::nullopt;
  }

  void act(std::uint32_t actor, const std::string& replay_address,
           const std::string& learner_address) {
    const ClientIdentity identity{kRunId, Role::kActor, actor, fresh_incarnation()};
    Client replay(replay_address, "replay server", identity, {});
    Client learner(learner_address, "learner", identity, {});
    replay.send(encode(ReplayRequest(Join{})));
    const auto joined = answer(replay);
    if (!joined) return;
    const std::uint64_t first = std::get<Joined>(decode_replay_reply(*joined)).next_round;
    for (std::uint64_t round = first; round < schedule_.rounds(); ++round) {
      const bool goes = round == actors_end_at;
      const std::uint64_t version = goes ? round : schedule_.weights_version(round);
      learner.send(encode(LearnerRequest(WeightsWanted{version})));
      const auto body = answer(learner);
      if (!body) return;
      const Weights got = std::get<Weights>(decode_learner_reply(*body));
      note(got);
      if (goes) {
        if (!actors_hang) stop_learner_ = true;
        minutes_pass_ = true;
        return;
      }
      if (schedule_.selects_in(round)) {
        learner.send(encode(LearnerRequest(made_up_outcome(round, actor))));
        if (!answer(learner)) return;
      }
      before_chunk(round, actor);
      replay.send(encode(ReplayRequest(made_up_chunk(config_, round, actor, got))));
      if (!answer(replay)) return;
    }
  }

  void note(const Weights& got) {
    const std::lock_guard lock(mutex_);
    weights.insert_or_assign(got.version, got);
    if (got.version >= stop_at_version) stop_learner_ = true;
  }

  const RunConfig config_;
  const Schedule schedule_;
  const RunDirectory& directory_;
  std::atomic<bool> stop_learner_ = false;
  std::atomic<bool> minutes_pass_ = false;
  testing_support::ManualClock clock_;
  std::atomic<bool> end_ = false;
  std::mutex mutex_;
  std::string error_;
};

}  // namespace corridor::learner
