// SPDX-License-Identifier: Apache-2.0
#include "learner/publisher.h"

#include <utility>

#include "proto/base/failure.h"
#include "proto/wire/codec.h"

namespace corridor::learner {
namespace {

// Within one call, so that no crowd of actors keeps the learner from training.
constexpr int kHandledAtOnce = 256;

}  // namespace

Publisher::Publisher(Server& server, std::size_t actors) : server_(server), actors_(actors) {}

void Publisher::publish(Weights weights) {
  const std::uint64_t version = weights.version;
  CORRIDOR_CHECK(versions_.empty() || version == versions_.back().version + 1,
                 "version {} after {}", version, versions_.back().version);
  versions_.push_back({version, encode(LearnerReply(std::move(weights)))});
  if (versions_.size() > 2) versions_.pop_front();
  outcomes_.erase(outcomes_.begin(), outcomes_.lower_bound(version));
  std::erase_if(parked_, [&](const Parked& parked) {
    if (parked.version != version) return false;
    server_.reply(parked.request, versions_.back().reply);
    return true;
  });
}

void Publisher::service(Duration patience) {
  for (int i = 0; i < kHandledAtOnce; ++i) {
    const std::optional<IncomingRequest> request =
        server_.receive(i == 0 ? patience : Duration::zero());
    if (!request) return;
    handle(*request);
  }
}

void Publisher::handle(const IncomingRequest& request) {
  if (request.client.role != Role::kActor || request.client.index >= actors_) {
    server_.refuse(request, fmt::format("client {} of a run with {} actors (run.actors)",
                                        request.client.index, actors_));
    return;
  }
  // A restarted actor asks anew; its old questions are void.
  std::erase_if(parked_, [&](const Parked& parked) {
    return parked.request.client == request.client &&
           parked.request.incarnation != request.incarnation;
  });
  try {
    const LearnerRequest decoded = decode_learner_request(request.body);
    std::visit([&](const auto& kind) { answer(request, kind); }, decoded);
  } catch (const Malformed& malformed) {
    server_.reject_malformed(request, malformed.what());
  }
}

void Publisher::answer(const IncomingRequest& request, const WeightsWanted& wanted) {
  for (const Version& version : versions_) {
    if (version.version != wanted.version) continue;
    server_.reply(request, version.reply);
    return;
  }
  if (!versions_.empty() && wanted.version < versions_.front().version) {
    server_.refuse(
        request, fmt::format("weights {} wanted, {} to {} are kept: no actor of this run "
                             "can need them",
                             wanted.version, versions_.front().version, versions_.back().version));
    return;
  }
  parked_.push_back({request, wanted.version});
}

void Publisher::answer(const IncomingRequest& request, const SelectionOutcome& outcome) {
  const std::uint64_t newest = versions_.empty() ? 0 : versions_.back().version;
  if (outcome.round > newest + 1) {
    server_.refuse(request, fmt::format("an outcome of round {} before weights {} exist",
                                        outcome.round, outcome.round - 1));
    return;
  }
  // A restarted actor may report an old round again, or the same outcome a second time.
  if (outcome.round >= newest) {
    auto& of_round = outcomes_[outcome.round];
    of_round.resize(actors_);
    of_round[request.client.index] = outcome;
  }
  server_.reply(request, encode(LearnerReply(Noted{})));
}

std::optional<SelectionOutcome> Publisher::selection(std::uint64_t round) const {
  if (!awaited(round).empty()) return std::nullopt;
  SelectionOutcome sum{.round = round};
  for (const std::optional<SelectionOutcome>& outcome : outcomes_.at(round)) {
    sum.episodes += outcome->episodes;
    sum.steps += outcome->steps;
    sum.reward += outcome->reward;
    sum.collisions += outcome->collisions;
  }
  return sum;
}

std::vector<std::uint32_t> Publisher::awaited(std::uint64_t round) const {
  const auto found = outcomes_.find(round);
  std::vector<std::uint32_t> missing;
  for (std::uint32_t actor = 0; actor < actors_; ++actor) {
    if (found == outcomes_.end() || !found->second[actor]) missing.push_back(actor);
  }
  return missing;
}

}  // namespace corridor::learner
