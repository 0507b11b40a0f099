// SPDX-License-Identifier: Apache-2.0
// The learner's work: block after block, batches in, weights out; phase after phase.
// docs/architecture.md, "Lockstep", says why the result does not depend on timing.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "learner/checkpointer.h"
#include "learner/learner_state.h"
#include "learner/publisher.h"
#include "learner/replay_client.h"
#include "learner/td_update.h"
#include "proto/run/metrics.h"
#include "proto/run/run_directory.h"
#include "proto/settings/schedule.h"
#include "proto/settings/settings.h"
#include "proto/system/clock.h"
#include "proto/system/test_delay.h"
#include "proto/system/time_account.h"

namespace corridor::learner {

// What a training talks to; all of it outlives the training.
struct Surroundings {
  const RunDirectory& directory;
  ReplayClient& replay;  // joined by `run`
  Publisher& publisher;  // fresh
  MetricsWriter& metrics;
  TimeAccount& time;
  std::function<bool()> stop_requested;
  Duration stop_patience{1500};  // asked to stop: how long to wait for a block's last chunks
  TestDelay delay = [] {};       // before each round
  Clock clock = steady_now;
};

// `average` after so many more updates that led to `newest`: what it held counts exp(-updates /
// window_updates), the newest weights the rest. A window of 0: the newest alone. Equal sizes
// (CHECK).
std::vector<float> running_average(std::vector<float> average, const std::vector<float>& newest,
                                   std::uint32_t updates, std::uint64_t window_updates);

// Before the first block: version 0 is published, with the networks that the run was given, else
// random ones.
LearnerState initial_state(const RunConfig& config, const std::optional<Networks>& given = {});

// The newest checkpoint's state, else the initial one. Throws Failure when the checkpoint is
// damaged or the configuration has changed.
LearnerState load_state(const RunConfig& config, const RunDirectory& directory);

class Training {
 public:
  Training(const RunConfig& config, Surroundings surroundings, LearnerState state);

  // Trains to the end; false when it was asked to stop before. Asked to stop, it ends the block in
  // progress (also one that waits for its chunks, if they come within stop_patience), takes a
  // checkpoint and returns; a resumed run then goes on bit for bit. Throws Failure when a peer is
  // lost, an actor hangs, or training diverges.
  bool run();

 private:
  struct BlockResult {
    double loss = 0.0;  // means over the block's updates
    double q_value = 0.0;
    double risk = 0.0;
    std::uint64_t updates = 0;  // in the phase so far
  };

  // Each returns false or nothing when it is to stop before it is done.
  bool train_round(std::uint64_t round);
  bool await_selection(std::uint64_t round);
  std::optional<Opened> await_block(std::uint64_t round);

  BlockResult train_block(std::uint64_t round, const Opened& opened);
  void consider(const SelectionOutcome& outcome);
  void finish_block(std::uint64_t round, std::uint32_t updates);
  void begin_phase(const TdState& initial);
  // The whole state, td_'s included.
  LearnerState state() const;
  // Begins a checkpoint of the state when there is none of it yet, and waits for it.
  void checkpoint_now();
  void finish_checkpoint();
  void report(std::uint64_t round, const Opened& opened, const BlockResult& result);

  const DqnSettings& dqn() const { return config_.phase(phase_); }

  const RunConfig config_;
  const Schedule schedule_;
  Surroundings around_;

  LearnerState state_;  // but for state_.td, which td_ holds
  Phase phase_;         // in progress
  std::unique_ptr<TdUpdate> td_;
  Checkpointer checkpointer_;
  std::uint64_t checkpointed_;  // next_round of the newest checkpoint that was begun
  bool checkpoint_due_ = false;

  std::optional<SelectionOutcome> selected_;  // in this round
  double score_ = 0.0;                        // of `selected_`
  std::int64_t steps_since_report_ = 0;
};

}  // namespace corridor::learner
