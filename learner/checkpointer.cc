// SPDX-License-Identifier: Apache-2.0
#include "learner/checkpointer.h"

#include <utility>

#include "proto/base/failure.h"
#include "proto/run/tensor_file.h"
#include "proto/system/log.h"

namespace corridor::learner {

Checkpointer::Checkpointer(const RunConfig& config, Checkpoints checkpoints, ReplayClient& replay,
                           Clock clock)
    : config_(config),
      checkpoints_(std::move(checkpoints)),
      replay_(replay),
      clock_(std::move(clock)) {}

Checkpointer::~Checkpointer() {
  replay_saved_ = {};  // a broken promise: its thread, if it waits, gives up
  if (writing_.valid()) writing_.wait();
}

void Checkpointer::begin(const LearnerState& state) {
  CORRIDOR_CHECK(!busy(), "round {}", round_);
  begun_ = clock_();
  round_ = state.next_round - 1;
  previous_ = checkpoints_.newest().value_or("").string();
  directory_ = checkpoints_.begin(round_);
  replay_saved_ = {};
  replay_is_saved_ = false;
  writing_ =
      std::async(std::launch::async, [tensors = to_tensors(state, config_), directory = directory_,
                                      checkpoints = checkpoints_, round = round_,
                                      kept = config_.schedule.checkpoints_kept,
                                      replay_saved = replay_saved_.get_future()]() mutable {
        write_tensors(directory / kLearnerFile, tensors);
        replay_saved.get();
        checkpoints.commit(round, kept);
      });
  ask_replay();  // now: what it holds now is what it saves
  training_waited_ = clock_() - begun_;
}

void Checkpointer::ask_replay() {
  if (replay_is_saved_ || !replay_.save(directory_, previous_)) return;
  replay_is_saved_ = true;
  replay_saved_.set_value();
}

void Checkpointer::advance() {
  if (!busy()) return;
  const TimePoint start = clock_();
  ask_replay();
  training_waited_ += clock_() - start;
  if (writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  writing_.get();
  log_info(
      "checkpoint after block {}: complete after {:.2f} s, for which training waited {:.1f} ms",
      round_, in_seconds(clock_() - begun_), 1000.0 * in_seconds(training_waited_));
}

}  // namespace corridor::learner
