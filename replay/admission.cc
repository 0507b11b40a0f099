// SPDX-License-Identifier: Apache-2.0
#include "replay/admission.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "proto/base/failure.h"

namespace corridor::replay {

Admission::Admission(std::size_t actors) : queues_(actors) {
  CORRIDOR_CHECK(actors >= 1, "{} actors", actors);
}

std::uint64_t Admission::next_round(std::size_t actor) const {
  return next_round_ + queues_.at(actor).parked.size();
}

const OpenEpisode& Admission::open_episode(std::size_t actor) const {
  const Queue& queue = queues_.at(actor);
  return queue.parked.empty() ? queue.admitted : queue.parked.back().open;
}

Admission::Parking Admission::park(std::size_t actor, Insert chunk) {
  if (chunk.round != next_round(actor)) return Parking::kOutOfTurn;
  Queue& queue = queues_.at(actor);
  if (queue.parked.size() == kRoundsAhead) return Parking::kTooEarly;
  queue.parked.push_back(std::move(chunk));
  return Parking::kParked;
}

std::vector<std::uint32_t> Admission::missing() const {
  std::vector<std::uint32_t> result;
  for (std::size_t actor = 0; actor < queues_.size(); ++actor) {
    if (queues_[actor].parked.empty()) result.push_back(static_cast<std::uint32_t>(actor));
  }
  return result;
}

std::vector<Insert> Admission::admit() {
  CORRIDOR_CHECK(missing().empty(), "{} chunks of round {} missing", missing().size(), next_round_);
  std::vector<Insert> chunks;
  for (Queue& queue : queues_) {
    queue.admitted = queue.parked.front().open;
    chunks.push_back(std::move(queue.parked.front()));
    queue.parked.erase(queue.parked.begin());
  }
  ++next_round_;
  return chunks;
}

void Admission::save(TensorFile& file) const {
  std::vector<std::uint64_t> episodes;
  std::vector<std::uint64_t> steps;
  std::vector<std::uint8_t> actions;
  for (const Queue& queue : queues_) {
    const OpenEpisode& open = queue.admitted;
    episodes.push_back(open.episode);
    steps.push_back(open.actions.size());
    actions.insert(actions.end(), open.actions.begin(), open.actions.end());
  }
  file.put("next_round", std::vector{next_round_});
  file.put("open_episodes", std::move(episodes));
  file.put("open_steps", std::move(steps));
  file.put("open_actions", std::move(actions));
}

void Admission::load(const TensorFile& file, const std::string& name) {
  const auto& round = file.get<std::uint64_t>("next_round", name);
  const auto& episodes = file.get<std::uint64_t>("open_episodes", name);
  const auto& steps = file.get<std::uint64_t>("open_steps", name);
  const auto& actions = file.get<std::uint8_t>("open_actions", name);
  if (round.size() != 1 || episodes.size() != actors() || steps.size() != actors()) {
    throw Failure(
        "{}: {} open episodes of {} actors, the run has {} actors; use the run's own checkpoint",
        name, episodes.size(), steps.size(), actors());
  }
  const bool fits = std::all_of(steps.begin(), steps.end(),
                                [&](std::uint64_t count) { return count <= actions.size(); }) &&
                    std::accumulate(steps.begin(), steps.end(), std::uint64_t{0}) == actions.size();
  if (!fits) {
    throw Failure(
        "{}: the open episodes' lengths do not add up to {}; the file is damaged, use an "
        "older checkpoint",
        name, actions.size());
  }
  auto first = actions.begin();
  for (std::size_t actor = 0; actor < actors(); ++actor) {
    const auto last = first + static_cast<std::ptrdiff_t>(steps[actor]);
    queues_[actor] = {OpenEpisode{episodes[actor], {first, last}}, {}};
    first = last;
  }
  next_round_ = round[0];
}

}  // namespace corridor::replay
