// SPDX-License-Identifier: Apache-2.0
#include "cluster/export.h"

#include "proto/base/failure.h"
#include "proto/config/run_config.h"
#include "proto/run/fingerprint.h"
#include "proto/run/manifest.h"
#include "proto/run/networks.h"
#include "proto/run/run_directory.h"
#include "proto/settings/schedule.h"
#include "proto/system/files.h"

namespace corridor::cluster {

void export_run(const std::filesystem::path& run, const std::filesystem::path& to) {
  const RunDirectory trained = RunDirectory::open(run);
  const RunConfig config = load_run_config(trained.config());
  if (rounds_done(trained) < Schedule(config).rounds()) {
    throw Failure("the training of {} is not complete: go on with corridor resume {}", run.string(),
                  run.string());
  }
  const auto networks = newest_networks(trained, config);
  CORRIDOR_CHECK(networks.has_value(), "{}", run.string());
  RunManifest manifest = read_manifest(trained);
  manifest.fingerprint = fingerprint(Checkpoints(trained.checkpoints()).newest().value());

  const RunDirectory exported = RunDirectory::create(to);
  FolderInTheMaking made(to);
  write_networks(exported, *networks);
  write_file(exported.config(), read_file(trained.config()));
  write_manifest(exported, manifest);
  made.keep();
}

}  // namespace corridor::cluster
