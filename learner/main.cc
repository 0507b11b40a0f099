// SPDX-License-Identifier: Apache-2.0
// corridor-learner RUN_DIRECTORY: trains a run's planners and publishes their weights.
#include <string>

#include "learner/blas.h"
#include "learner/publisher.h"
#include "learner/replay_client.h"
#include "learner/td_networks.h"
#include "learner/training.h"
#include "proto/config/run_config.h"
#include "proto/run/checkpoints.h"
#include "proto/run/manifest.h"
#include "proto/run/metrics.h"
#include "proto/run/run_directory.h"
#include "proto/system/command_line.h"
#include "proto/system/identity.h"
#include "proto/system/log.h"
#include "proto/system/program.h"
#include "proto/system/test_delay.h"
#include "proto/system/time_account.h"
#include "proto/wire/connect.h"
#include "proto/wire/endpoint.h"

namespace {

using namespace corridor;

void log_libraries(const learner::Blas& blas, Device device) {
  log_info("LibTorch {} on {}, BLAS {} {}", learner::libtorch_version(), name_of(device),
           blas.library, blas.core);
  const std::string warning = learner::warning_about(blas);
  if (!warning.empty()) log_warning(warning);
}

// The bits depend on its kernels, which only who has loaded it knows: the manifest says with which
// the run is trained. Throws Failure when it was with others and that is not allowed.
void record_kernels(const learner::Blas& blas, const RunDirectory& directory, bool allowed) {
  RunManifest manifest = read_manifest(directory);
  RunVersions here = manifest.versions_now();
  here.blas_core = blas.core;
  here.blas_config = blas.config;
  if (here == manifest.versions_now()) return;
  const std::vector<ChangedVersion> changed = changed_versions(manifest.versions_now(), here);
  if (changed.empty()) {
    manifest.versions_now() = here;
  } else {
    manifest.go_on({rounds_done(directory), here, allowed_changes(changed, allowed)});
  }
  write_manifest(directory, manifest);
}

int run(const std::string& root, bool allow_other_bits) {
  learner::use_one_torch_thread();
  const RunDirectory directory = RunDirectory::open(root);
  const RunConfig config = load_run_config(directory.config());
  const std::string run_id = read_manifest(directory).run_id;
  learner::check_device(config.run.device);
  const learner::Blas blas = learner::blas_in_use();
  log_libraries(blas, config.run.device);
  record_kernels(blas, directory, allow_other_bits);

  learner::LearnerState state = learner::load_state(config, directory);
  MetricsWriter metrics(directory.metrics(kLearnerName));
  Server server(addresses(config.run, run_id, root).learner, run_id);
  learner::Publisher publisher(server, static_cast<std::size_t>(config.run.actors));
  Client client =
      connect_to_replay(config.run, {run_id, Role::kLearner, 0, draw_incarnation()}, root);
  TimeAccount time;
  learner::ReplayClient replay(client, time, [&] { publisher.service(Duration::zero()); });
  learner::Training training(config,
                             {.directory = directory,
                              .replay = replay,
                              .publisher = publisher,
                              .metrics = metrics,
                              .time = time,
                              .stop_requested = stop_requested,
                              .delay = test_delay()},
                             std::move(state));
  training.run();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  learner::use_portable_kernels(argv);
  CLI::App app("The learner of a corridor run; `corridor` starts it.");
  std::string root;
  bool allow_other_bits = false;
  app.add_flag(kAllowOtherBits, allow_other_bits, "go on with other kernels of BLAS");
  app.add_option("RUN_DIRECTORY", root, "the run, as `corridor train` made it")->required();
  return run_program(kLearnerProgram, [&] {
    const auto done = parse_command_line(app, kLearnerProgram, argc, argv);
    return done ? *done : run(root, allow_other_bits);
  });
}
