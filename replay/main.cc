// corridor-replay RUN_DIRECTORY: the prioritized replay server of a run.
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <string>

#include "proto/checkpoints.h"
#include "proto/metrics.h"
#include "proto/program.h"
#include "proto/run_config.h"
#include "proto/run_directory.h"
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
    spdlog::info("resumes from {}, at round {}", checkpoint->string(), service.next_round());
  }
  MetricsWriter metrics(directory.metrics("replay"));
  Server server(addresses(config.run, run_id).replay, run_id);
  replay::serve(server, service, metrics, config, stop_requested);
  spdlog::info("ends at round {}; {} messages dropped", service.next_round(), server.dropped());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Prioritized replay server of a corridor run; `corridor` starts it.");
  std::string root;
  app.add_option("RUN_DIRECTORY", root, "the run, as `corridor train` made it")->required();
  app.set_version_flag("--version", corridor::kVersion);
  CLI11_PARSE(app, argc, argv);
  return corridor::run_program("corridor-replay", [&] { return run(root); });
}
