// SPDX-License-Identifier: Apache-2.0
#include "cluster/export.h"

#include "proto/base/failure.h"
#include "proto/base/text.h"
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
  if (std::filesystem::exists(trained.networks()) && read_manifest(trained).fingerprint) {
    throw Failure("{} is exported already: copy its folder", run.string());
  }
  const auto inside =
      std::filesystem::weakly_canonical(to).lexically_relative(std::filesystem::canonical(run));
  if (!inside.empty() && *inside.begin() != "..") {
    throw Failure("{} lies in {}: choose a place outside the run", to.string(), run.string());
  }
  const RunConfig config = load_run_config(trained.config());
  if (rounds_done(trained) < Schedule(config).rounds()) {
    throw Failure("the training of {} is not complete: go on with corridor resume {}", run.string(),
                  shell_quoted(run.string()));
  }
  const auto networks = newest_networks(trained, config);
  CORRIDOR_CHECK(networks.has_value(), "{}", run.string());
  RunManifest manifest = read_manifest(trained);
  manifest.fingerprint = fingerprint(Checkpoints(trained.checkpoints()).newest().value());

  NewRun made(to);
  const RunDirectory& exported = made.directory();
  write_networks(exported, *networks);
  write_file(exported.config(), read_file(trained.config()));
  write_manifest(exported, manifest);
  exported.remove_empty_folders();
  if (!made.publish()) throw Failure("{} exists by now: choose another name", to.string());
}

}  // namespace corridor::cluster
