// SPDX-License-Identifier: Apache-2.0
#include "learner/training.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "proto/base/failure.h"
#include "proto/base/text.h"
#include "proto/run/checkpoints.h"
#include "proto/system/log.h"

namespace corridor::learner {
namespace {

constexpr std::chrono::minutes kHangs{30};  // no round of any scenario takes that long
constexpr std::int64_t kStepsPerReport = 2500;

double between(double first, double last, double progress) {
  return first + (last - first) * progress;
}

}  // namespace

std::vector<float> running_average(std::vector<float> average, const std::vector<float>& newest,
                                   std::uint32_t updates, std::uint64_t window_updates) {
  CORRIDOR_CHECK(average.size() == newest.size(), "{} and {}", average.size(), newest.size());
  if (window_updates == 0) return newest;
  const auto kept = static_cast<float>(
      std::exp(-static_cast<double>(updates) / static_cast<double>(window_updates)));
  for (std::size_t i = 0; i < average.size(); ++i) {
    average[i] = newest[i] + kept * (average[i] - newest[i]);
  }
  return average;
}

LearnerState initial_state(const RunConfig& config, const std::optional<Networks>& given) {
  Networks networks;
  for (const NamedNetwork& network : kNetworks) {
    const NetworkId id = network.id;
    networks[id] = given ? (*given)[id]
                         : initial_parameters(config.network(id), config.run.seed, id,
                                              config.phase(id).networks());
  }
  LearnerState state;
  state.td = initial_td_state(networks[kNetworks.front().id]);
  state.published.push_back({0, std::move(networks)});
  return state;
}

LearnerState load_state(const RunConfig& config, const RunDirectory& directory) {
  const auto checkpoint = Checkpoints(directory.checkpoints()).newest();
  if (!checkpoint) return initial_state(config, given_networks(directory, config));
  return from_tensors(read_checkpoint_file(*checkpoint, kLearnerFile), config,
                      (*checkpoint / kLearnerFile).string());
}

Training::Training(const RunConfig& config, Surroundings surroundings, LearnerState state)
    : config_(config),
      schedule_(config),
      around_(std::move(surroundings)),
      state_(std::move(state)),
      phase_(phase_in_progress(schedule_, state_.next_round)),
      checkpointer_(config_, Checkpoints(around_.directory.checkpoints()), around_.replay,
                    around_.clock),
      checkpointed_(state_.next_round) {
  begin_phase(state_.td);
}

void Training::begin_phase(const TdState& initial) {
  td_ = std::make_unique<TdUpdate>(config_.network(phase_), dqn(), config_.run.device, initial);
}

bool Training::run() {
  for (const Weights& weights : state_.published) around_.publisher.publish(weights);
  around_.replay.join(state_.next_round);
  log_info("goes on with block {} of {} ({}), {} updates done", state_.next_round,
           schedule_.rounds(), phase_name(phase_), td_->updates());
  while (state_.next_round < schedule_.rounds()) {
    const std::uint64_t round = state_.next_round;
    if (around_.stop_requested()) {
      checkpoint_now();
      return false;
    }
    if (!train_round(round)) return false;
    checkpointer_.advance();
    checkpoint_due_ |= schedule_.checkpoints_after(round);
    if (checkpoint_due_ && !checkpointer_.busy()) {
      checkpoint_due_ = false;
      checkpointed_ = state_.next_round;
      checkpointer_.begin(state());
    }
    around_.time.charge(TimePart::kCheckpoint);
  }
  checkpoint_now();
  log_info("all {} blocks are done", schedule_.rounds());
  return true;
}

bool Training::train_round(std::uint64_t round) {
  around_.delay();
  if (schedule_.selects_in(round) && !await_selection(round)) {
    checkpoint_now();
    return false;
  }
  const std::optional<Opened> opened = await_block(round);
  if (!opened) {
    log_info("stops while block {} waits for actors: resuming goes on from the newest checkpoint",
             round);
    return false;
  }
  const BlockResult result = train_block(round, *opened);
  finish_block(round, opened->batches);
  report(round, *opened, result);
  selected_.reset();
  return true;
}

bool Training::await_selection(std::uint64_t round) {
  const TimePoint start = around_.clock();
  while (!(selected_ = around_.publisher.selection(round))) {
    if (around_.stop_requested()) return false;
    if (around_.clock() - start > kHangs) {
      throw Failure(
          "round {}: actors {} have not reported their evaluation in {} min: see their "
          "logs, then resume the run",
          round, listed(around_.publisher.awaited(round)), kHangs.count());
    }
    around_.publisher.service(kGlance);
    around_.time.charge(TimePart::kWaitForActors);
  }
  consider(*selected_);
  return true;
}

void Training::consider(const SelectionOutcome& outcome) {
  if (outcome.steps == 0) throw Failure("round {}: an evaluation of no steps", outcome.round);
  score_ = (outcome.reward -
            config_.schedule.selection_collision_cost * static_cast<double>(outcome.collisions)) *
           1000.0 / static_cast<double>(outcome.steps);
  const std::uint64_t version = schedule_.weights_version(outcome.round);
  const bool better = !state_.best || score_ > state_.best->score;
  log_info("{} of version {}: score {:.1f} per 1000 steps{}", phase_name(phase_), version, score_,
           better ? ", the best so far" : "");
  if (!better) return;
  // Round r drives the version before the newest of block r, or the newest where a phase begins.
  const auto found = std::find_if(state_.published.begin(), state_.published.end(),
                                  [&](const Weights& w) { return w.version == version; });
  CORRIDOR_CHECK(found != state_.published.end(), "version {} in round {}", version, outcome.round);
  state_.best = Candidate{version, score_, found->networks[phase_]};
}

std::optional<Opened> Training::await_block(std::uint64_t round) {
  const TimePoint start = around_.clock();
  std::optional<TimePoint> stopping;
  const auto give_up = [&] {
    if (around_.clock() - start > kHangs) {
      throw Failure(
          "round {}: chunks of actors are missing for {} min: see replay.log for which, "
          "then resume the run",
          round, kHangs.count());
    }
    if (!around_.stop_requested()) return false;
    if (!stopping) stopping = around_.clock();
    return around_.clock() - *stopping >= around_.stop_patience;
  };
  return around_.replay.open_block(round, give_up);
}

Training::BlockResult Training::train_block(std::uint64_t round, const Opened& opened) {
  const double progress = schedule_.annealed(round);
  const double learning_rate = between(dqn().learning_rate, dqn().learning_rate_end, progress);
  const Block block{opened.batches, static_cast<std::uint32_t>(dqn().batch_size),
                    between(dqn().importance_exponent, dqn().importance_exponent_end, progress)};
  BlockResult result;
  around_.replay.run_block(block, [&](const Batch& batch) {
    around_.time.charge(TimePart::kTransport);
    TdUpdate::Result update = td_->update(batch, learning_rate);
    around_.time.charge(TimePart::kUpdate);
    result.loss += update.loss / opened.batches;
    result.q_value += update.q_value / opened.batches;
    result.risk += update.risk / opened.batches;
    return std::move(update.priorities);
  });
  result.updates = td_->updates();
  return result;
}

void Training::finish_block(std::uint64_t round, std::uint32_t updates) {
  Weights next = state_.published.back();
  next.version = round + 1;
  std::vector<float>& learned = next.networks[phase_];
  // What was published last is the average so far; a window never reaches back before the phase.
  const auto window_updates = static_cast<std::uint64_t>(dqn().averaging_updates);
  learned = schedule_.ends_phase(round) && state_.best
                ? state_.best->parameters
                : running_average(std::move(learned), td_->parameters(), updates,
                                  std::min(window_updates, td_->updates()));
  state_.published.push_back(next);
  if (state_.published.size() > 2) state_.published.erase(state_.published.begin());
  state_.next_round = round + 1;

  if (const Phase now = phase_in_progress(schedule_, state_.next_round); now != phase_) {
    log_info("the {} is done and frozen; the {}'s phase begins", phase_name(phase_),
             phase_name(now));
    phase_ = now;
    state_.best.reset();
    begin_phase(initial_td_state(next.networks[phase_]));
  }
  around_.publisher.publish(std::move(next));
  around_.time.charge(TimePart::kPublish);
}

LearnerState Training::state() const {
  LearnerState state = state_;
  state.td = td_->state();
  return state;
}

void Training::checkpoint_now() {
  finish_checkpoint();
  if (checkpointed_ == state_.next_round) return;
  checkpointed_ = state_.next_round;
  checkpointer_.begin(state());
  finish_checkpoint();
}

void Training::finish_checkpoint() {
  const TimePoint start = around_.clock();
  while (checkpointer_.busy()) {
    if (around_.clock() - start > kHangs) {
      throw Failure("a checkpoint is not complete after {} min: is the disk of {} alive?",
                    kHangs.count(), around_.directory.root().string());
    }
    around_.publisher.service(kGlance);
    checkpointer_.advance();
    around_.time.charge(TimePart::kCheckpoint);
  }
}

void Training::report(std::uint64_t round, const Opened& opened, const BlockResult& result) {
  // finish_block may have begun the next phase.
  const Phase phase = schedule_.phase_of(round);
  const DqnSettings& settings = config_.phase(phase);
  steps_since_report_ += schedule_.steps_per_round();
  const std::int64_t every =
      std::max<std::int64_t>(1, kStepsPerReport / schedule_.steps_per_round());
  const auto rounds_done = static_cast<std::int64_t>(round - schedule_.first_round(phase) + 1);
  if (!selected_ && !schedule_.ends_phase(round) && rounds_done % every != 0) return;

  std::vector<std::pair<std::string, double>> values = {
      {metric::kStepsPerS, static_cast<double>(steps_since_report_) / around_.time.wall_s()},
      {metric::kUpdates, static_cast<double>(result.updates)},
      {metric::kLearningRate,
       between(settings.learning_rate, settings.learning_rate_end, schedule_.annealed(round))}};
  for (auto& value : around_.time.take()) values.push_back(std::move(value));
  if (opened.batches > 0) {
    values.emplace_back(metric::kTdLoss, result.loss);
    values.emplace_back(metric::kQValues, result.q_value);
    if (settings.networks() > 1) values.emplace_back(metric::kRiskValues, result.risk);
  }
  if (selected_) {
    const double thousands = static_cast<double>(selected_->steps) / 1000.0;
    values.emplace_back(metric::kGreedyRewardPer1000, selected_->reward / thousands);
    values.emplace_back(metric::kGreedyCollisionsPer1000,
                        static_cast<double>(selected_->collisions) / thousands);
    values.emplace_back(metric::kGreedyScore, score_);
  }
  around_.metrics.write(phase_name(phase), round, schedule_.phase_steps_after(round), values);
  steps_since_report_ = 0;
}

}  // namespace corridor::learner
