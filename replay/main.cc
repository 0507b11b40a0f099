// SPDX-License-Identifier: Apache-2.0
// corridor-replay RUN_DIRECTORY: the prioritized replay server of a run.
#include <string>

#include "proto/config/run_config.h"
#include "proto/run/checkpoints.h"
#include "proto/run/manifest.h"
#include "proto/run/metrics.h"
#include "proto/run/run_directory.h"
#include "proto/system/command_line.h"
#include "proto/system/log.h"
#include "proto/system/program.h"
#include "proto/system/test_delay.h"
#include "proto/wire/connect.h"
#include "replay/replay_service.h"
#include "replay/serve.h"

namespace {

int run(const std::string& root) {
  using namespace corridor;
  const RunDirectory directory = RunDirectory::open(root);
  const RunConfig config = load_run_config(directory.config());
  const std::string run_id = read_manifest(directory).run_id;

  replay::ReplayService service(config);
  if (const auto checkpoint = Checkpoints(directory.checkpoints()).newest()) {
    service.load(*checkpoint);
    log_info("resumes from {}, at round {}", checkpoint->string(), service.next_round());
  }
  MetricsWriter metrics(directory.metrics(kReplayName));
  Server server(addresses(config.run, run_id, root).replay, run_id);
  replay::serve(server, service, metrics, config, {stop_requested, test_delay()});
  log_info("ends at round {}; {} messages dropped", service.next_round(), server.dropped());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Prioritized replay server of a corridor run; `corridor` starts it.");
  std::string root;
  app.add_option("RUN_DIRECTORY", root, "the run, as `corridor train` made it")->required();
  return corridor::run_program(corridor::kReplayProgram, [&] {
    const auto done = corridor::parse_command_line(app, corridor::kReplayProgram, argc, argv);
    return done ? *done : run(root);
  });
}
