// SPDX-License-Identifier: Apache-2.0
// The order in which chunks enter the replay: (round, actor), whatever the order in which they
// arrive. Chunks of later rounds are parked, at most kRoundsAhead an actor.
//
// It also keeps every actor's open episode, both as of the admitted rounds (a checkpoint's part)
// and as of the parked ones (where a restarted actor goes on). One thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "proto/run/tensor_file.h"
#include "proto/wire/messages.h"

namespace corridor::replay {

class Admission {
 public:
  // With block b the last to be opened, rounds b + 1 and b + 2 can be driven; round b + 3 needs
  // weights that block b + 1 yields (proto/settings/schedule.h).
  static constexpr std::size_t kRoundsAhead = 2;

  enum class Parking {
    kParked,
    kOutOfTurn,  // not the actor's next round: next_round(actor)
    kTooEarly,   // kRoundsAhead chunks of the actor are parked already
  };

  // Expects round 0 of every actor.
  explicit Admission(std::size_t actors);

  std::size_t actors() const { return queues_.size(); }
  // The first round that has not been admitted.
  std::uint64_t next_round() const { return next_round_; }
  // The first round of which this actor has sent nothing.
  std::uint64_t next_round(std::size_t actor) const;
  // As of the round before next_round(actor).
  const OpenEpisode& open_episode(std::size_t actor) const;

  Parking park(std::size_t actor, Insert chunk);

  // The actors whose chunks of next_round() have not come, ascending; it can be admitted when
  // there are none.
  std::vector<std::uint32_t> missing() const;
  // The chunks of next_round() in the order of the actors; missing() must be empty (CHECK).
  std::vector<Insert> admit();

  // next_round() and the open episodes as of the rounds before it; parked chunks are not part.
  // "next_round", "open_episodes" [actor], "open_steps" [actor], "open_actions" [all steps].
  void save(TensorFile& file) const;
  // Forgets what was parked. Throws Failure naming the file when its numbers do not fit together.
  void load(const TensorFile& file, const std::string& name);

 private:
  struct Queue {
    OpenEpisode admitted;        // as of the round before next_round_
    std::vector<Insert> parked;  // rounds next_round_, next_round_ + 1, ...
  };

  std::uint64_t next_round_ = 0;
  std::vector<Queue> queues_;  // [actor]
};

}  // namespace corridor::replay
