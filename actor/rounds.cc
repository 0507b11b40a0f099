// SPDX-License-Identifier: Apache-2.0
#include "actor/rounds.h"

#include <algorithm>
#include <optional>

#include "actor/rollout.h"
#include "proto/base/failure.h"
#include "proto/run/metrics.h"
#include "proto/settings/schedule.h"
#include "proto/system/log.h"
#include "proto/system/program.h"
#include "proto/wire/codec.h"
#include "proto/wire/connect.h"
#include "proto/wire/endpoint.h"

namespace corridor::actor {
namespace {

// How long one look at a socket may last before the stop flag is looked at.
constexpr Duration kPatience{100};
// Steps of the phase, all actors together, between two lines of metrics.
constexpr std::int64_t kStepsPerMetricsLine = 4000;

// The next answer; nothing when the process is asked to stop first.
std::optional<Body> answer(Client& client) {
  while (!stop_requested()) {
    if (auto body = client.receive(kPatience)) return body;
  }
  return std::nullopt;
}

class Trainer {
 public:
  Trainer(const RunConfig& config, const RunDirectory& directory, const ClientIdentity& identity,
          world::World& world, TimeAccount& time, const TestDelay& delay)
      : config_(config),
        actor_(static_cast<int>(identity.index)),
        world_(world),
        time_(time),
        delay_(delay),
        schedule_(config),
        metrics_(directory.metrics(actor_name(actor_))),
        replay_(connect_to_replay(config.run, identity, directory.root())),
        learner_(connect_to_learner(config.run, identity, directory.root())) {}

  void run() {
    replay_.send(encode(ReplayRequest(Join{})));
    const auto body = answer(replay_);
    if (!body) return;
    const auto joined = expect<Joined>(*body, decode_replay_reply, "replay server");
    log_info("joins at round {} of {}", joined.next_round, schedule_.rounds());
    OpenEpisode open = joined.open;
    for (std::uint64_t round = joined.next_round; round < schedule_.rounds(); ++round) {
      if (!rollout_ || rollout_->phase() != schedule_.phase_of(round)) {
        rollout_.emplace(config_, actor_, world_, time_, round, open);
        open = {};
      }
      if (!drive_round(round)) return;
    }
    drain(replay_);
    drain(learner_);
  }

 private:
  // False when the process is asked to stop.
  bool drive_round(std::uint64_t round) {
    if (!fetch_weights(schedule_.weights_version(round))) return false;
    if (schedule_.selects_in(round)) {
      learner_.send(encode(LearnerRequest(rollout_->select(weights_))));
      // Noted before the round's chunk goes out: where the chunk is known, so is the outcome.
      const auto body = answer(learner_);
      if (!body) return false;
      expect<Noted>(*body, decode_learner_reply, "learner");
      time_.charge(TimePart::kWaitForLearner);
    }
    // The weights of the next round are asked for while this one is driven: they arrive meanwhile.
    if (round + 1 < schedule_.rounds()) ask_for(schedule_.weights_version(round + 1));
    time_.charge(TimePart::kTransport);
    const Insert chunk = rollout_->drive_round(weights_);
    delay_();

    // One chunk may be under way while the next is driven, not two.
    const Body body = encode(ReplayRequest(chunk));
    time_.charge(TimePart::kTransport);
    if (!drain(replay_)) return false;
    time_.charge(TimePart::kWaitForReplay);
    replay_.send(body);
    report(round);
    return true;
  }

  void ask_for(std::uint64_t version) {
    if (asked_ == version) return;
    learner_.send(encode(LearnerRequest(WeightsWanted{version})));
    asked_ = version;
  }

  bool fetch_weights(std::uint64_t version) {
    ask_for(version);
    time_.charge(TimePart::kTransport);
    if (have_ != version) {
      const auto body = answer(learner_);
      if (!body) return false;
      time_.charge(TimePart::kWaitForLearner);
      weights_ = expect<Weights>(*body, decode_learner_reply, "learner");
      check_weights();
      have_ = version;
    }
    return true;
  }

  void check_weights() const {
    for (const NamedNetwork& network : kNetworks) {
      const std::size_t size = weights_.networks[network.id].size();
      if (weights_.version == asked_ && size == config_.parameters(network.id)) continue;
      throw Failure(
          "the learner sent weights of version {} with a {} of {} parameters, which are not those "
          "asked for: is it of another configuration?",
          weights_.version, network.phase_name, size);
    }
  }

  static bool drain(Client& client) {
    while (client.unanswered() > 0) {
      if (!answer(client)) return false;
    }
    return true;
  }

  void report(std::uint64_t round) {
    const std::int64_t lines_apart =
        std::max<std::int64_t>(1, kStepsPerMetricsLine / schedule_.steps_per_round());
    const bool due = static_cast<std::int64_t>(round + 1) % lines_apart == 0;
    if (!due && !schedule_.ends_phase(round)) return;
    const RolloutTotals totals = rollout_->take_totals();
    const auto steps = static_cast<double>(std::max<std::int64_t>(totals.steps, 1));
    std::vector<std::pair<std::string, double>> values = {
        {metric::kStepsPerS, steps / time_.wall_s()},
        {metric::kRewardPer1000, 1000.0 * totals.reward / steps},
        {metric::kCollisionsPer1000, 1000.0 * static_cast<double>(totals.collisions) / steps},
        {metric::kEpsilon, totals.epsilon}};
    for (auto& value : time_.take()) values.push_back(std::move(value));
    if (totals.episodes > 0) {
      const auto episodes = static_cast<double>(totals.episodes);
      values.emplace_back(metric::kEpisodicReturn, totals.episodic_return / episodes);
      values.emplace_back(metric::kEpisodes, episodes);
    }
    metrics_.write(phase_name(schedule_.phase_of(round)), round, schedule_.phase_steps_after(round),
                   values);
  }

  const RunConfig& config_;
  int actor_;
  world::World& world_;
  TimeAccount& time_;
  const TestDelay& delay_;
  Schedule schedule_;
  MetricsWriter metrics_;
  Client replay_;
  Client learner_;
  std::optional<PhaseRollout> rollout_;

  Weights weights_;
  std::optional<std::uint64_t> have_;   // version of weights_
  std::optional<std::uint64_t> asked_;  // the latest version asked for
};

}  // namespace

void train(const RunConfig& config, const RunDirectory& directory, const ClientIdentity& identity,
           world::World& world, TimeAccount& time, const TestDelay& delay) {
  Trainer(config, directory, identity, world, time, delay).run();
}

}  // namespace corridor::actor
