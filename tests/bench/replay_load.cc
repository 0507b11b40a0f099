// SPDX-License-Identifier: Apache-2.0
// replay_load: plays actors and a learner against one replay server, without SUMO: recorded chunks
// go in, batches come out, as fast as the server answers. The server is the real loop and service
// (replay/serve.h) in a process of its own, behind a real ipc socket; actors keep to the lockstep,
// one chunk unanswered each. With --floor the same messages meet a server that answers each with
// bytes made before, and clients that look at none: what transport alone costs.
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "proto/base/failure.h"
#include "proto/base/random.h"
#include "proto/run/metrics.h"
#include "proto/system/command_line.h"
#include "proto/system/program.h"
#include "proto/wire/codec.h"
#include "proto/wire/endpoint.h"
#include "replay/replay_service.h"
#include "replay/serve.h"
#include "tests/support/batches.h"
#include "tests/support/temporary_directory.h"

namespace corridor::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kRunId = "0123456789abcdef0123456789abcdef";
constexpr std::uint32_t kRowsPerStep = 512;
constexpr std::uint32_t kDepth = 2;  // steps under way, as the learner's
constexpr Duration kPatience{20'000};
constexpr double kWarmUp_s = 0.5;

struct Load {
  int actors = 1;
  int row_bytes = 400;
  int chunk = 256;
  double samples_per_insert = 4.0;  // 0: nothing is drawn
  std::int64_t capacity = 100'000;
  double seconds = 2.0;
  bool floor = false;
};

// Rows of the length that comes nearest: two observations and five numbers of 4 bytes; a MoP's
// observation has 3 + 5 corridors + 6 clearance steps.
RunConfig config_of(const Load& load) {
  const int observations = (load.row_bytes / static_cast<int>(sizeof(float)) - 5) / 2;
  RunConfig config;
  config.planner.clearance_steps = std::max(0, observations - kMopScalars) % kMopPerCorridor;
  config.planner.corridors_per_lane =
      std::max(1, (observations - kMopScalars - kMopMoves * config.planner.clearance_steps) /
                      kMopPerCorridor);
  config.run.actors = load.actors;
  config.schedule.steps_per_round = load.chunk;
  for (DqnSettings& dqn : config.dqn) {
    dqn.capacity = load.capacity;
    dqn.minimum_size = kRowsPerStep;
    dqn.steps = std::int64_t{1} << 40;
  }
  return config;
}

RowLayout layout_of(const Load& load) { return {config_of(load).shape(Phase::kMop).observations}; }

std::vector<float> numbers(std::size_t count, std::uint64_t stream) {
  std::vector<float> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = static_cast<float>(random_unit(1, Purpose::kBootstrap, {stream, i}));
  }
  return values;
}

Insert chunk_of(const Load& load) {
  const RowLayout layout = layout_of(load);
  Insert chunk;
  chunk.observations = static_cast<std::uint32_t>(layout.observations);
  chunk.rows = numbers(static_cast<std::size_t>(load.chunk) * layout.stride(), 0);
  chunk.priorities = numbers(static_cast<std::size_t>(load.chunk), 1);
  chunk.open.actions.assign(500, 7);
  return chunk;
}

// ---- The server's process

// Answers as fast as it can.
void answer_from_memory(Server& server, const Load& load) {
  const RowLayout layout = layout_of(load);
  Batch batch;
  batch.observations = static_cast<std::uint32_t>(layout.observations);
  batch.rows = numbers(kRowsPerStep * layout.stride(), 2);
  batch.keys.assign(kRowsPerStep, 1);
  batch.weights.assign(kRowsPerStep, 1.0F);
  const Body drawn = testing_support::encoded(batch);
  const Body nothing = testing_support::encoded({});
  const Body inserted = encode(ReplayReply(Inserted{}));
  const Body opened = encode(ReplayReply(Opened{1}));
  constexpr std::size_t kSmall = 1024;
  while (!stop_requested()) {
    const auto request = server.receive(Duration(100));
    if (!request) continue;
    const ByteView body = request->body;
    if (request->client.role == Role::kActor) {
      server.reply(*request, inserted);
    } else if (body.size() > kSmall) {
      server.reply(*request, drawn);
    } else {
      const ReplayRequest small = decode_replay_request(body);
      const auto* step = std::get_if<Step>(&small);
      server.reply(*request, step == nullptr ? opened : step->count > 0 ? drawn : nothing);
    }
  }
}

int serve(const Load& load, const Address& address, const std::filesystem::path& metrics_file) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  return run_program("replay_load's server", [&] {
    Server server(address, kRunId);
    if (load.floor) {
      answer_from_memory(server, load);
      return 0;
    }
    const RunConfig config = config_of(load);
    replay::ReplayService service(config);
    MetricsWriter metrics(metrics_file);
    replay::serve(server, service, metrics, config, {stop_requested});
    return 0;
  });
}

// ---- The clients' process

struct Counters {
  std::atomic<std::uint64_t> opened{0};  // blocks
  std::atomic<std::uint64_t> inserted{0};
  std::atomic<std::uint64_t> sampled{0};
  std::atomic<bool> measuring{false};
  std::atomic<bool> end{false};
};

Body answer(Client& client) {
  std::optional<Body> body = client.receive(kPatience);
  if (!body) throw Failure("no answer in {} s", kPatience.count() / 1000);
  return *body;
}

// Round after round a chunk of each actor. Returns the answers' latencies while measuring, in us.
std::vector<double> play_actors(const Load& load, const Address& address, Counters& counters) {
  std::vector<std::unique_ptr<Client>> clients;
  for (int i = 0; i < load.actors; ++i) {
    clients.push_back(std::make_unique<Client>(
        address, "replay server",
        ClientIdentity{kRunId, Role::kActor, static_cast<std::uint32_t>(i), 1}, ClientLimits{}));
  }
  Insert chunk = chunk_of(load);
  std::vector<double> latencies_us;
  std::vector<Clock::time_point> sent(clients.size());
  std::vector<bool> waits(clients.size());
  for (std::uint64_t round = 0; !counters.end; ++round) {
    // A round needs weights that the block two before it yields.
    while (counters.opened + 1 < round && !counters.end) std::this_thread::yield();
    if (counters.end) break;
    chunk.round = round;
    const Body body = encode(ReplayRequest(chunk));
    for (std::size_t i = 0; i < clients.size(); ++i) {
      sent[i] = Clock::now();
      clients[i]->send(body);
      waits[i] = true;
    }
    for (std::size_t open = clients.size(); open > 0;) {
      for (std::size_t i = 0; i < clients.size(); ++i) {
        if (!waits[i] || !clients[i]->receive(open == 1 ? Duration(1) : Duration(0))) continue;
        waits[i] = false;
        --open;
        counters.inserted += static_cast<std::uint64_t>(load.chunk);
        if (!counters.measuring) continue;
        latencies_us.push_back(
            std::chrono::duration<double, std::micro>(Clock::now() - sent[i]).count());
      }
      if (counters.end) break;
    }
  }
  return latencies_us;
}

// Block after block: opens it, draws what its rows ask for, looks at every row, returns priorities.
void play_learner(const Load& load, const Address& address, Counters& counters) {
  Client client(address, "replay server", {kRunId, Role::kLearner, 0, 1}, {});
  const std::vector<float> priorities = numbers(kRowsPerStep, 3);
  Step step{{}, {}, kRowsPerStep, 0.4};
  const Body first = encode(ReplayRequest(step));
  step.keys.assign(kRowsPerStep, 1);
  step.priorities = priorities;
  const Body next = encode(ReplayRequest(step));
  double owed = 0.0;
  volatile float seen = 0.0F;
  for (std::uint64_t round = 0; !counters.end; ++round) {
    client.send(encode(ReplayRequest(OpenBlock{round})));
    std::optional<Body> opened;
    while (!(opened = client.receive(Duration(100)))) {
      if (counters.end) return;
    }
    counters.opened = round + 1;
    owed += load.samples_per_insert * load.chunk * load.actors / kRowsPerStep;
    const auto steps = static_cast<std::uint32_t>(owed);
    owed -= steps;
    std::uint32_t sent = 0;
    for (; sent < std::min(steps, kDepth); ++sent) client.send(first);
    for (std::uint32_t i = 0; i < steps; ++i) {
      const Body body = answer(client);
      Body reply = next;
      if (!load.floor) {
        const ReceivedBatch batch = decode_batch(body).value();
        float sum = 0.0F;
        for (const float value : batch.rows) sum += value;
        seen = seen + sum;
        step.keys.assign(batch.keys.begin(), batch.keys.end());
        step.count = sent < steps ? kRowsPerStep : 0;
        reply = encode(ReplayRequest(step));
      }
      client.send(reply);
      ++sent;
      counters.sampled += kRowsPerStep;
    }
    for (std::uint32_t i = 0; i < std::min(steps, kDepth); ++i) answer(client);
  }
}

// ---- One measurement

double cpu_s(pid_t process) {
  clockid_t clock;
  timespec time{};
  if (clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &time) != 0) {
    throw Failure("process {} has ended", process);
  }
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double resident_mb(pid_t process) {
  std::ifstream file(fmt::format("/proc/{}/statm", process));
  double size = 0.0, resident = 0.0;
  file >> size >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

struct Outcome {
  double inserts_per_s = 0.0;
  double samples_per_s = 0.0;
  double p50_us = 0.0;
  double p99_us = 0.0;
  double server_us_per_row = 0.0;  // of its processor time; rows in and out
  double server_mb = 0.0;
};

// A process that ends with its owner.
class ServerProcess {
 public:
  ServerProcess(const Load& load, const Address& address, const std::filesystem::path& metrics)
      : pid_(fork()) {
    if (pid_ < 0) throw Failure("fork failed");
    if (pid_ == 0) _exit(serve(load, address, metrics));
  }
  ~ServerProcess() {
    kill(pid_, SIGTERM);
    waitpid(pid_, nullptr, 0);
  }
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;
  pid_t pid() const { return pid_; }

 private:
  pid_t pid_;
};

Outcome measure(const Load& load) {
  static int count = 0;
  const Address address = fmt::format("ipc://@corridor-load-{}-{}", getpid(), count++);
  const testing_support::TemporaryDirectory temporary;
  const ServerProcess server(load, address, temporary.path() / "replay.jsonl");

  Counters counters;
  std::vector<double> latencies_us;
  std::atomic<bool> failed{false};
  const auto guarded = [&](const auto& play) {
    return [&] {
      try {
        play();
      } catch (const std::exception& error) {
        std::fprintf(stderr, "replay_load: %s\n", error.what());
        failed = true;
        counters.end = true;
      }
    };
  };
  const auto actors = [&] { latencies_us = play_actors(load, address, counters); };
  const auto learner = [&] { play_learner(load, address, counters); };
  std::thread actors_thread(guarded(actors));
  std::thread learner_thread(guarded(learner));

  const auto pass = [&](double seconds) {
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  };
  // The ring is full before the measurement, so that memory does not grow in it.
  const Clock::time_point start = Clock::now();
  const auto full = static_cast<std::uint64_t>(load.floor ? 0 : load.capacity);
  while (!counters.end && (counters.inserted < full ||
                           Clock::now() - start < std::chrono::duration<double>(kWarmUp_s))) {
    pass(0.01);
  }
  Outcome outcome;
  if (!failed) {
    const Clock::time_point begin = Clock::now();
    const double cpu_before_s = cpu_s(server.pid());
    const std::uint64_t inserted = counters.inserted, sampled = counters.sampled;
    counters.measuring = true;
    pass(load.seconds);
    counters.measuring = false;
    const double passed_s = std::chrono::duration<double>(Clock::now() - begin).count();
    const auto in = static_cast<double>(counters.inserted - inserted);
    const auto out = static_cast<double>(counters.sampled - sampled);
    outcome = {in / passed_s,
               out / passed_s,
               0.0,
               0.0,
               1e6 * (cpu_s(server.pid()) - cpu_before_s) / std::max(1.0, in + out),
               resident_mb(server.pid())};
  }
  counters.end = true;
  actors_thread.join();
  learner_thread.join();
  if (failed) throw Failure("the measurement failed");
  std::sort(latencies_us.begin(), latencies_us.end());
  if (!latencies_us.empty()) {
    outcome.p50_us = latencies_us[latencies_us.size() / 2];
    outcome.p99_us = latencies_us[latencies_us.size() * 99 / 100];
  }
  return outcome;
}

void print_head() {
  std::printf("%7s %9s %7s %11s %6s %12s %12s %9s %9s %10s %8s\n", "actors", "row", "drawn",
              "capacity", "", "inserts/s", "samples/s", "p50 us", "p99 us", "us/row", "MB");
}

void print(const Load& load, const Outcome& outcome) {
  std::printf("%7d %7d B %7.2f %11lld %6s %12.0f %12.0f %9.0f %9.0f %10.3f %8.0f\n", load.actors,
              load.row_bytes, load.samples_per_insert, static_cast<long long>(load.capacity),
              load.floor ? "floor" : "", outcome.inserts_per_s, outcome.samples_per_s,
              outcome.p50_us, outcome.p99_us, outcome.server_us_per_row, outcome.server_mb);
  std::fflush(stdout);
}

// The server against its floor, in turns: A B A B.
void compare(Load load, int turns) {
  print_head();
  std::vector<double> insert_ratios, sample_ratios;
  for (int i = 0; i < turns; ++i) {
    load.floor = false;
    const Outcome real = measure(load);
    print(load, real);
    load.floor = true;
    const Outcome floor = measure(load);
    print(load, floor);
    insert_ratios.push_back(real.inserts_per_s / floor.inserts_per_s);
    sample_ratios.push_back(real.samples_per_s / floor.samples_per_s);
  }
  const auto median = [](std::vector<double>& values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
  };
  std::printf("share of the floor: inserts %.2f", median(insert_ratios));
  if (load.samples_per_insert > 0.0) std::printf(", samples %.2f", median(sample_ratios));
  std::printf("\n");
}

void sweep(const Load& load) {
  print_head();
  for (const int row_bytes : {400, 4'000, 40'000}) {
    for (const double samples_per_insert : {0.0, load.samples_per_insert}) {
      for (const int actors : {1, 4, 16, 64, 256}) {
        Load one = load;
        one.row_bytes = row_bytes;
        one.samples_per_insert = samples_per_insert;
        one.actors = actors;
        // At most 400 MB of rows; large rows come in smaller chunks.
        one.capacity = std::min<std::int64_t>(load.capacity, 400'000'000 / row_bytes);
        one.chunk = row_bytes > 10'000 ? 32 : 256;
        print(one, measure(one));
      }
    }
  }
}

void memory(Load load) {
  print_head();
  for (const std::int64_t capacity : {50'000, 200'000, 1'000'000}) {
    load.capacity = capacity;
    print(load, measure(load));
  }
}

}  // namespace
}  // namespace corridor::bench

int main(int argc, char** argv) {
  using namespace corridor::bench;
  CLI::App app("Plays actors and a learner against one replay server.");
  Load load;
  int turns = 5;
  app.add_option("--actors", load.actors, "how many");
  app.add_option("--row-bytes", load.row_bytes, "of a transition");
  app.add_option("--chunk", load.chunk, "rows an insert");
  app.add_option("--samples-per-insert", load.samples_per_insert, "0: nothing is drawn");
  app.add_option("--capacity", load.capacity, "rows");
  app.add_option("--seconds", load.seconds, "of a measurement");
  app.add_option("--turns", turns, "compare: how often");
  bool comparing = false, sweeping = false, remembering = false;
  app.add_flag("--compare", comparing, "the server and its floor in turns");
  app.add_flag("--sweep", sweeping, "1 to 256 actors, rows of 0.4 to 40 kB");
  app.add_flag("--memory", remembering, "memory against capacity");
  app.add_flag("--floor", load.floor, "no work at either end");
  CLI11_PARSE(app, argc, argv);
  return corridor::run_program("replay_load", [&] {
    if (comparing) {
      compare(load, turns);
    } else if (sweeping) {
      sweep(load);
    } else if (remembering) {
      memory(load);
    } else {
      print_head();
      print(load, measure(load));
    }
    return 0;
  });
}
