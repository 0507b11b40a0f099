#include "cluster/export.h"

#include "proto/base/failure.h"
#include "proto/base/json.h"
#include "proto/config/run_config.h"
#include "proto/run/fingerprint.h"
#include "proto/run/networks.h"
#include "proto/run/run_directory.h"
#include "proto/settings/schedule.h"
#include "proto/system/files.h"

namespace corridor::cluster {

void export_run(const std::filesystem::path& run, const std::filesystem::path& to) {
  const RunDirectory trained = RunDirectory::open(run);
  const RunConfig config = load_run_config(trained.config());
  const auto checkpoint = newest_checkpoint(trained);
  if (!checkpoint || checkpoint->rounds_done < Schedule(config).rounds()) {
    throw Failure("the training of {} is not complete: go on with corridor resume {}", run.string(),
                  run.string());
  }
  const auto networks = newest_networks(trained, config);
  CORRIDOR_CHECK(networks.has_value(), "{}", run.string());
  OrderedJson manifest = OrderedJson::parse(read_file(trained.manifest()), nullptr, false);
  if (!manifest.is_object()) throw Failure("{} is no JSON object", trained.manifest().string());
  manifest["fingerprint"] = fingerprint(*checkpoint);

  const RunDirectory exported = RunDirectory::create(to);
  write_networks(exported, *networks);
  write_file(exported.config(), read_file(trained.config()));
  write_file(exported.manifest(), manifest.dump(2) + "\n");
}

}  // namespace corridor::cluster
