#include "replay/serve.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "proto/codec.h"
#include "proto/random.h"
#include "proto/schedule.h"

namespace corridor::replay {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr Duration kPatience{100};
constexpr Seconds kSilence{5.0};  // before it is worth a line in the log
constexpr std::uint64_t kBlocksPerMetrics = 32;

class Loop {
 public:
  Loop(Server& server, ReplayService& service, MetricsWriter& metrics, const RunConfig& config)
      : server_(server),
        service_(service),
        metrics_(metrics),
        schedule_(config),
        seed_(config.run.seed),
        delay_max_(config.run.delay_ms_max / 1000.0) {}

  void turn() {
    Seconds& waiting = service_.awaited().empty() ? for_learner_ : for_actors_;
    const std::optional<IncomingRequest> request = server_.receive(kPatience);
    waiting += lap();
    if (request) carry_out(*request);
    if (opening_) open_or_tell();
    busy_ += lap();
  }

 private:
  void carry_out(const IncomingRequest& request) {
    try {
      ReplayRequest decoded = decode_replay_request(request.body);
      const bool of_block = std::holds_alternative<OpenBlock>(decoded);
      if (of_block || std::holds_alternative<Insert>(decoded)) delay();
      const Outcome outcome = service_.handle(request.client, std::move(decoded));
      if (const auto* reply = std::get_if<ReplayReply>(&outcome)) {
        server_.reply(request, encode(*reply));
      } else if (const auto* refusal = std::get_if<Refused>(&outcome)) {
        spdlog::warn("refused {} {}: {}", request.client.role == Role::kActor ? "actor" : "learner",
                     request.client.index, refusal->text);
        server_.refuse(request, refusal->text);
      } else {
        // An earlier OpenBlock that still waits came from a learner that has been replaced.
        opening_ = request;
        opening_since_ = Clock::now();
        write_metrics();
      }
    } catch (const Malformed& malformed) {
      spdlog::warn("malformed request: {}", malformed.what());
      server_.reject_malformed(request, malformed.what());
    }
  }

  void open_or_tell() {
    if (const std::optional<Opened> opened = service_.try_open()) {
      server_.reply(*opening_, encode(*opened));
      opening_.reset();
    } else if (Clock::now() - opening_since_ > kSilence) {
      std::string actors;
      for (const std::uint32_t actor : service_.awaited()) actors += fmt::format(" {}", actor);
      spdlog::info("block {} waits for the chunks of actors{}", service_.next_round(), actors);
      opening_since_ = Clock::now();
    }
  }

  // As of the block that has just ended: the same numbers in every run of one configuration.
  void write_metrics() {
    const std::uint64_t blocks = service_.next_round();
    if (blocks == 0 || blocks % kBlocksPerMetrics != 0) return;
    auto values = service_.metrics();
    values.emplace_back("replay/wait_for_actors_s", for_actors_.count());
    values.emplace_back("replay/wait_for_learner_s", for_learner_.count());
    values.emplace_back("replay/busy_s", busy_.count());
    const std::uint64_t round = blocks - 1;
    metrics_.write(phase_name(schedule_.phase_of(round)), round,
                   schedule_.phase_steps_before(round) + schedule_.steps_per_round(), values);
    for_actors_ = for_learner_ = busy_ = Seconds{0.0};
  }

  // A test aid (run.delay_ms_max): results must not depend on how fast anything is.
  void delay() {
    if (delay_max_ <= Seconds{0.0}) return;
    std::this_thread::sleep_for(delay_max_ * random_unit(seed_, Purpose::kWireDelay, {delays_++}));
  }

  Seconds lap() {
    const Clock::time_point before = std::exchange(mark_, Clock::now());
    return mark_ - before;
  }

  Server& server_;
  ReplayService& service_;
  MetricsWriter& metrics_;
  const Schedule schedule_;
  const std::uint64_t seed_;
  const Seconds delay_max_;

  std::optional<IncomingRequest> opening_;  // the OpenBlock that waits
  Clock::time_point opening_since_;         // or since it was last told
  Clock::time_point mark_ = Clock::now();
  Seconds for_actors_{0.0};
  Seconds for_learner_{0.0};
  Seconds busy_{0.0};
  std::uint64_t delays_ = 0;
};

}  // namespace

void serve(Server& server, ReplayService& service, MetricsWriter& metrics, const RunConfig& config,
           const std::function<bool()>& stop) {
  Loop loop(server, service, metrics, config);
  while (!stop()) loop.turn();
}

}  // namespace corridor::replay
