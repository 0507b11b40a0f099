// SPDX-License-Identifier: Apache-2.0
#include "replay/replay_service.h"

#include <chrono>

#include "proto/base/failure.h"
#include "proto/run/checkpoints.h"
#include "proto/run/metrics.h"
#include "proto/settings/limits.h"
#include "proto/wire/codec.h"
#include "replay/limiter.h"

namespace corridor::replay {
namespace {

namespace fs = std::filesystem;

template <typename... Args>
Refused refused(fmt::format_string<Args...> format, Args&&... args) {
  return {fmt::format(format, std::forward<Args>(args)...)};
}

}  // namespace

ReplayService::ReplayService(const RunConfig& config)
    : config_(config),
      schedule_(config),
      admission_(static_cast<std::size_t>(config.run.actors)),
      store_(config.phase(phase_), layout(phase_), config.run.seed, phase_, 0) {}

void ReplayService::begin(Phase phase, std::uint64_t first_key) {
  phase_ = phase;
  store_ = Store(config_.phase(phase), layout(phase), config_.run.seed, phase, first_key);
}

Outcome ReplayService::handle(ClientId client, ReplayRequest request) {
  const std::size_t known = client.role == Role::kActor ? admission_.actors() : 1;
  if (client.index >= known) {
    return refused("index {} of a run with {} {}", client.index, known,
                   client.role == Role::kActor ? "actors (run.actors)" : "learner");
  }
  const bool of_actors = std::holds_alternative<Insert>(request);
  if (!std::holds_alternative<Join>(request) && of_actors != (client.role == Role::kActor)) {
    return refused("{} sends no such request", of_actors ? "a learner" : "an actor");
  }
  return std::visit([&](auto& kind) { return answer(client, std::move(kind)); }, request);
}

Outcome ReplayService::answer(ClientId client, const Join&) {
  if (client.role == Role::kLearner) return Joined{next_round(), {}};
  const std::uint64_t next = admission_.next_round(client.index);
  // An actor's episodes are counted in a phase: none is carried over into the next one.
  const bool begins_phase =
      next < schedule_.rounds() && next == schedule_.first_round(schedule_.phase_of(next));
  return Joined{next, begins_phase ? OpenEpisode{} : admission_.open_episode(client.index)};
}

Outcome ReplayService::answer(ClientId client, Insert&& chunk) {
  const std::uint64_t round = chunk.round;
  if (round >= schedule_.rounds()) {
    return refused("a chunk of round {} in a run of {} rounds", round, schedule_.rounds());
  }
  const RowLayout rows = layout(schedule_.phase_of(round));
  if (static_cast<int>(chunk.observations) != rows.observations ||
      chunk.rows.size() != chunk.priorities.size() * rows.stride()) {
    return refused("{} floats for {} rows of {} observations; round {} has rows of {} observations",
                   chunk.rows.size(), chunk.priorities.size(), chunk.observations, round,
                   rows.observations);
  }
  if (!are_finite(chunk.rows)) return refused("rows of round {} hold NaN or infinity", round);
  if (!are_priorities(chunk.priorities)) {
    return refused("priorities of round {} are not all finite and >= 0", round);
  }
  switch (admission_.park(client.index, std::move(chunk))) {
    case Admission::Parking::kParked:
      return Inserted{};
    case Admission::Parking::kOutOfTurn:
      return refused("a chunk of round {} from actor {}, whose next is round {}", round,
                     client.index, admission_.next_round(client.index));
    case Admission::Parking::kTooEarly:
      break;
  }
  return refused("a chunk of round {} from actor {} before round {} is complete", round,
                 client.index, next_round());
}

Outcome ReplayService::answer(ClientId, const OpenBlock& request) {
  if (request.round != next_round() || request.round >= schedule_.rounds()) {
    return refused("block {} wanted, the next is block {} of {}; resume from the last checkpoint",
                   request.round, next_round(), schedule_.rounds());
  }
  open_ = false;
  waits_ = true;
  return Waiting{};
}

std::optional<Opened> ReplayService::try_open() {
  if (!waits_ || !admission_.missing().empty()) return std::nullopt;
  const Phase phase = schedule_.phase_of(next_round());
  if (phase != phase_) begin(phase, store_.next_key());

  const DqnSettings& dqn = config_.phase(phase_);
  const std::uint64_t granted = granted_batches(dqn, store_.inserted());
  for (const Insert& chunk : admission_.admit()) store_.insert(chunk.rows, chunk.priorities);
  const std::uint64_t batches = granted_batches(dqn, store_.inserted()) - granted;
  CORRIDOR_CHECK(batches <= UINT32_MAX, "{} batches", batches);
  waits_ = false;
  open_ = true;
  return Opened{static_cast<std::uint32_t>(batches)};
}

Outcome ReplayService::answer(ClientId, const Step& request) {
  if (!open_) return refused("a step outside an open block");
  if (request.keys.size() != request.priorities.size()) {
    return refused("{} keys, {} priorities", request.keys.size(), request.priorities.size());
  }
  for (const std::uint64_t key : request.keys) {
    if (key >= store_.next_key()) {
      return refused("a priority for key {}, the next is {}", key, store_.next_key());
    }
  }
  if (!are_priorities(request.priorities)) return refused("priorities not all finite and >= 0");
  if (!(request.importance_exponent >= 0.0 && request.importance_exponent <= 1.0)) {
    return refused("an importance exponent of {}", request.importance_exponent);
  }
  if (request.count > 0 && store_.size() == 0) {
    return refused("{} rows wanted, none held", request.count);
  }
  if (request.count * store_.layout().stride() * sizeof(float) > kDataBytesMax) {
    return refused("{} rows wanted, more than a message holds", request.count);
  }
  store_.update(request.keys, request.priorities);
  const BatchToFill batch =
      batch_to_fill(static_cast<std::uint32_t>(store_.layout().observations), request.count);
  store_.sample(request.importance_exponent, {batch.rows, batch.keys, batch.weights});
  return EncodedBatch{batch.body};
}

Outcome ReplayService::answer(ClientId, const Save& request) {
  if (request.directory.empty()) return refused("a checkpoint wanted in no directory");
  if (waits_) return refused("a checkpoint wanted while block {} is to open", next_round());
  open_ = false;
  try {
    if (saved_in_ != request.directory) {
      saving_ = std::async(std::launch::async, write, snapshot(request.previous),
                           fs::path(request.directory), fs::path(request.previous));
      saved_in_ = request.directory;
    }
    if (!saving_.valid()) return Saved{true};
    if (saving_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return Saved{false};
    saving_.get();
    return Saved{true};
  } catch (const Failure& failure) {
    return Refused{failure.what()};
  }
}

std::vector<std::uint32_t> ReplayService::awaited() const {
  return waits_ ? admission_.missing() : std::vector<std::uint32_t>{};
}

std::vector<std::pair<std::string, double>> ReplayService::metrics() const {
  const auto value = [](std::uint64_t count) { return static_cast<double>(count); };
  const std::uint64_t counted = counted_rows(config_.phase(phase_), store_.inserted());
  return {
      {metric::kReplaySize, value(store_.size())},
      {metric::kReplayInserted, value(store_.inserted())},
      {metric::kReplaySampled, value(store_.sampled())},
      {metric::kSamplesPerInsert, counted == 0 ? 0.0 : value(store_.sampled()) / value(counted)},
      {metric::kStalePriorities, value(store_.stale_priorities())}};
}

Snapshot ReplayService::snapshot(const fs::path& previous) const {
  Snapshot result;
  admission_.save(result.head);
  store_.save(result.head);
  result.stride = store_.layout().stride();
  if (!previous.empty()) result.files = rows_files(previous);
  // Of the phase before, and of keys that have given way, nothing is needed any more.
  std::erase_if(result.files,
                [&](const RowsFile& file) { return file.end_key <= store_.oldest_key(); });
  result.first_new_key = result.files.empty() ? store_.oldest_key() : result.files.back().end_key;
  if (result.first_new_key > store_.next_key()) {
    throw Failure("{} has rows up to key {}, the replay up to {}: it is of another run",
                  previous.string(), result.first_new_key, store_.next_key());
  }
  result.rows = store_.rows_from(result.first_new_key);
  return result;
}

void ReplayService::load_head(const TensorFile& head, const std::string& name) {
  admission_.load(head, name);
  if (next_round() > schedule_.rounds()) {
    throw Failure("{}: {} rounds in a run of {}; use the run's own checkpoint", name, next_round(),
                  schedule_.rounds());
  }
  begin(schedule_.phase_of(next_round() == 0 ? 0 : next_round() - 1), 0);
  store_.load(head, name);
  waits_ = false;
  open_ = false;
}

void ReplayService::load(const fs::path& checkpoint) {
  load_head(read_checkpoint_file(checkpoint, kReplayFile), (checkpoint / kReplayFile).string());
  const std::vector<RowsFile> files = rows_files(checkpoint);
  const bool covers = files.empty() ? store_.size() == 0
                                    : files.front().first_key <= store_.oldest_key() &&
                                          files.back().end_key == store_.next_key();
  if (!covers) {
    throw Failure("{} is damaged: it has not all rows with the keys {} to {}", checkpoint.string(),
                  store_.oldest_key(), store_.next_key());
  }
  for (const RowsFile& file : files) {
    store_.load_rows(file.first_key, read_checkpoint_file(checkpoint, file.name()),
                     (checkpoint / file.name()).string());
  }
}

}  // namespace corridor::replay
