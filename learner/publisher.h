// SPDX-License-Identifier: Apache-2.0
// What the learner serves to actors: weights by version, and a place to report greedy evaluations.
// One thread; nothing happens outside its calls.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "proto/wire/endpoint.h"
#include "proto/wire/messages.h"

namespace corridor::learner {

class Publisher {
 public:
  // `actors`: how many the run has, and how many outcomes make a selection.
  Publisher(Server& server, std::size_t actors);

  // Makes a version the newest, one above the last one (any at first), and answers those that wait
  // for it. The one before stays available: an actor may be a version behind
  // (proto/settings/schedule.h).
  void publish(Weights weights);

  // Answers what has come, or comes within `patience`: weights now or once published, outcomes at
  // once. What is malformed or impossible is refused. Costs a system call when nothing is there.
  void service(Duration patience);

  // The sum over all actors' outcomes for `round`, once the last one is in; actors in order, so
  // that the sum does not depend on their speed. Kept for the newest version's round and the next
  // one.
  std::optional<SelectionOutcome> selection(std::uint64_t round) const;
  // Actors whose outcome for `round` is missing.
  std::vector<std::uint32_t> awaited(std::uint64_t round) const;

 private:
  struct Version {
    std::uint64_t version = 0;
    Bytes reply;  // encoded once for all actors
  };
  struct Parked {
    IncomingRequest request;
    std::uint64_t version = 0;
  };

  void handle(const IncomingRequest& request);
  void answer(const IncomingRequest& request, const WeightsWanted& wanted);
  void answer(const IncomingRequest& request, const SelectionOutcome& outcome);

  Server& server_;
  std::size_t actors_;
  std::deque<Version> versions_;  // the newest two, ascending
  std::vector<Parked> parked_;    // at most a client's window for each actor
  std::map<std::uint64_t, std::vector<std::optional<SelectionOutcome>>>
      outcomes_;  // [round][actor]
};

}  // namespace corridor::learner
