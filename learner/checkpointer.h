// SPDX-License-Identifier: Apache-2.0
// Takes the run's checkpoints (proto/run/checkpoints.h) beside the training: what has to wait for a
// disk does so in threads, the learner's and the replay server's. One checkpoint at a time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <future>
#include <string>

#include "learner/learner_state.h"
#include "learner/replay_client.h"
#include "proto/run/checkpoints.h"
#include "proto/settings/settings.h"
#include "proto/system/clock.h"

namespace corridor::learner {

class Checkpointer {
 public:
  // `replay` outlives it.
  Checkpointer(const RunConfig& config, Checkpoints checkpoints, ReplayClient& replay,
               Clock clock = steady_now);
  // Waits for its thread. A checkpoint that is not complete never will be.
  ~Checkpointer();
  Checkpointer(const Checkpointer&) = delete;
  Checkpointer& operator=(const Checkpointer&) = delete;

  // Whether one is under way.
  bool busy() const { return writing_.valid(); }

  // Between blocks, not busy: begins one of this state, and of the replay's present one.
  void begin(const LearnerState& state);

  // Between blocks: goes on with what is under way. Throws Failure when it cannot be written.
  void advance();

 private:
  void ask_replay();

  const RunConfig& config_;
  Checkpoints checkpoints_;
  ReplayClient& replay_;
  const Clock clock_;

  // Of the one under way.
  std::uint64_t round_ = 0;
  std::filesystem::path directory_;
  std::string previous_;
  std::promise<void> replay_saved_;
  bool replay_is_saved_ = false;
  std::future<void> writing_;
  TimePoint begun_;
  TimePoint::duration training_waited_{0};
};

}  // namespace corridor::learner
