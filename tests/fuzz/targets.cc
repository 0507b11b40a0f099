// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/targets.h"

#include <cstring>
#include <string>

#include "cluster/watch/training_progress.h"
#include "learner/learner_state.h"
#include "proto/base/failure.h"
#include "proto/base/json.h"
#include "proto/config/config_values.h"
#include "proto/config/run_config.h"
#include "proto/run/actor_task.h"
#include "proto/run/evaluation_record.h"
#include "proto/run/json_record.h"
#include "proto/run/metrics.h"
#include "proto/run/tensor_file.h"
#include "proto/wire/codec.h"
#include "replay/replay_service.h"

namespace corridor::fuzz {
namespace {

ByteView bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::byte*>(text.data()), text.size()};
}

template <typename Decode>
void decode_or_refuse(const Decode& decode) {
  try {
    decode();
  } catch (const Malformed&) {
  }
}

template <typename Read>
void read_or_fail(const Read& read) {
  try {
    read();
  } catch (const Failure&) {
  }
}

// Whatever is accepted means the same once it has been written again.
template <typename Value>
void check_again(const Value& value, Value (*decode)(ByteView)) {
  CORRIDOR_CHECK(encode(value) == encode(decode(encode(value))), "another value");
}

void read_message(std::string_view text) {
  const ByteView bytes = bytes_of(text);
  decode_or_refuse([&] { check_again(decode_header(bytes), decode_header); });
  decode_or_refuse([&] { check_again(decode_replay_request(bytes), decode_replay_request); });
  decode_or_refuse([&] { check_again(decode_replay_reply(bytes), decode_replay_reply); });
  decode_or_refuse([&] { check_again(decode_learner_request(bytes), decode_learner_request); });
  decode_or_refuse([&] { check_again(decode_learner_reply(bytes), decode_learner_reply); });
  decode_or_refuse([&] { decode_batch(Body(Bytes(bytes.begin(), bytes.end()))); });
}

RunConfig small_config() {
  return parse_run_config(
      "[mop]\ncapacity = 64\nminimum_size = 4\nbatch_size = 4\nsteps = 64\nhidden = [4]\n"
      "[bp]\ncapacity = 64\nminimum_size = 4\nbatch_size = 4\nsteps = 64\nhidden = [4]\n"
      "[schedule]\nsteps_per_round = 8\n",
      "fuzz");
}

// A conversation with a replay server: (who: one byte, size: two bytes, message) again and again.
void read_requests(std::string_view bytes) {
  static const RunConfig config = small_config();
  constexpr std::size_t kHeadBytes = 3;
  replay::ReplayService service(config);
  while (bytes.size() >= kHeadBytes) {
    const auto who = static_cast<unsigned char>(bytes[0]);
    std::uint16_t size = 0;
    std::memcpy(&size, bytes.data() + 1, sizeof size);
    bytes.remove_prefix(kHeadBytes);
    const std::string_view message = bytes.substr(0, size);
    bytes.remove_prefix(message.size());
    const ClientId client{who < 128 ? Role::kActor : Role::kLearner, who % 4u};
    decode_or_refuse([&] {
      ReplayRequest request = decode_replay_request(bytes_of(message));
      if (std::holds_alternative<Save>(request)) return;  // which writes files of any name
      service.handle(client, std::move(request));
      service.try_open();
    });
  }
}

void read_scenario(std::string_view text) {
  read_or_fail([&] {
    const std::string written = to_toml(parse_run_config(std::string(text), "fuzz"));
    CORRIDOR_CHECK(to_toml(parse_run_config(written, "written")) == written, "another value");
  });
}

void read_checkpoint(std::string_view bytes) {
  static const RunConfig config = small_config();
  read_or_fail([&] {
    const TensorFile file = parse_tensors(bytes, "fuzz");
    read_or_fail([&] { learner::from_tensors(file, config, "fuzz"); });
    read_or_fail([&] { replay::ReplayService(config).load_head(file, "fuzz"); });
    replay::Store store(config.phase(Phase::kMop), RowLayout{2}, 1, Phase::kMop, 0);
    store.insert(std::vector<float>(3 * store.layout().stride()), std::vector<float>(3));
    read_or_fail([&] { store.load_rows(0, file, "fuzz"); });
  });
}

// What `corridor` reads of what other processes wrote.
void read_records(std::string_view text) {
  parse_metrics_line(text);
  parse_step_count(text);
  const auto json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_discarded())
    read_or_fail([&] { parse_record<EvaluationRecord>(json, "fuzz", "evaluation"); });
}

constexpr Target kTargets[] = {{"message", read_message},
                               {"requests", read_requests},
                               {"scenario", read_scenario},
                               {"checkpoint", read_checkpoint},
                               {"records", read_records}};

}  // namespace

std::span<const Target> targets() { return kTargets; }

}  // namespace corridor::fuzz
