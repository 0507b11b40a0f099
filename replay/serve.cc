// SPDX-License-Identifier: Apache-2.0
#include "replay/serve.h"

#include <chrono>
#include <optional>
#include <utility>

#include "proto/base/text.h"
#include "proto/settings/schedule.h"
#include "proto/system/log.h"
#include "proto/system/time_account.h"
#include "proto/wire/codec.h"

namespace corridor::replay {
namespace {

constexpr Duration kPatience{100};
constexpr std::chrono::seconds kSilence{5};  // before it is worth a line in the log
constexpr std::uint64_t kBlocksPerMetrics = 32;

class Loop {
 public:
  Loop(Server& server, ReplayService& service, MetricsWriter& metrics, const RunConfig& config,
       const ServeHooks& hooks)
      : server_(server), service_(service), metrics_(metrics), schedule_(config), hooks_(hooks) {}

  void turn() {
    const bool chunks_missing = !service_.awaited().empty();
    const std::optional<IncomingRequest> request = server_.receive(kPatience);
    time_.charge(chunks_missing ? TimePart::kWaitForActors : TimePart::kWaitForLearner);
    if (request) carry_out(*request);
    if (opening_) open_or_tell();
  }

 private:
  void carry_out(const IncomingRequest& request) {
    try {
      ReplayRequest decoded = decode_replay_request(request.body);
      const bool of_block = std::holds_alternative<OpenBlock>(decoded);
      if (of_block || std::holds_alternative<Insert>(decoded)) hooks_.delay();
      const TimePart work = part_of(decoded);
      time_.charge(TimePart::kTransport);
      const Outcome outcome = service_.handle(request.client, std::move(decoded));
      time_.charge(work);
      if (const auto* reply = std::get_if<ReplayReply>(&outcome)) {
        server_.reply(request, encode(*reply));
      } else if (const auto* batch = std::get_if<EncodedBatch>(&outcome)) {
        server_.reply(request, batch->body);
      } else if (const auto* refusal = std::get_if<Refused>(&outcome)) {
        log_warning("refused {} {}: {}", request.client.role == Role::kActor ? "actor" : "learner",
                    request.client.index, refusal->text);
        server_.refuse(request, refusal->text);
      } else {
        // An earlier OpenBlock that still waits came from a learner that has been replaced.
        opening_ = request;
        opening_since_ = hooks_.clock();
        write_metrics();
      }
    } catch (const Malformed& malformed) {
      log_warning("malformed request: {}", malformed.what());
      server_.reject_malformed(request, malformed.what());
    }
    time_.charge(TimePart::kTransport);
  }

  static TimePart part_of(const ReplayRequest& request) {
    if (std::holds_alternative<Insert>(request)) return TimePart::kInsert;
    if (std::holds_alternative<Step>(request)) return TimePart::kSample;
    if (std::holds_alternative<Save>(request)) return TimePart::kCheckpoint;
    return TimePart::kTransport;
  }

  void open_or_tell() {
    const std::optional<Opened> opened = service_.try_open();
    time_.charge(TimePart::kInsert);
    if (opened) {
      server_.reply(*opening_, encode(*opened));
      opening_.reset();
    } else if (hooks_.clock() - opening_since_ > kSilence) {
      log_info("block {} waits for the chunks of actors {}", service_.next_round(),
               listed(service_.awaited(), " "));
      opening_since_ = hooks_.clock();
    }
  }

  // As of the block that has just ended: the same numbers in every run of one configuration.
  void write_metrics() {
    const std::uint64_t blocks = service_.next_round();
    if (blocks == 0 || blocks % kBlocksPerMetrics != 0) return;
    auto values = service_.metrics();
    for (auto& value : time_.take()) values.push_back(std::move(value));
    const std::uint64_t round = blocks - 1;
    metrics_.write(phase_name(schedule_.phase_of(round)), round, schedule_.phase_steps_after(round),
                   values);
  }

  Server& server_;
  ReplayService& service_;
  MetricsWriter& metrics_;
  const Schedule schedule_;
  const ServeHooks& hooks_;

  std::optional<IncomingRequest> opening_;  // the OpenBlock that waits
  TimePoint opening_since_;                 // or since it was last told
  TimeAccount time_;
};

}  // namespace

void serve(Server& server, ReplayService& service, MetricsWriter& metrics, const RunConfig& config,
           const ServeHooks& hooks) {
  Loop loop(server, service, metrics, config, hooks);
  while (!hooks.stop()) loop.turn();
}

}  // namespace corridor::replay
