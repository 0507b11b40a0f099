#include "cluster/export.h"

#include <nlohmann/json.hpp>

#include "cluster/checkpoint.h"
#include "proto/failure.h"
#include "proto/networks.h"
#include "proto/run_config.h"
#include "proto/run_directory.h"
#include "proto/schedule.h"

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
  nlohmann::ordered_json manifest =
      nlohmann::ordered_json::parse(read_file(trained.manifest()), nullptr, false);
  if (!manifest.is_object()) throw Failure("{} is no JSON object", trained.manifest().string());
  manifest["fingerprint"] = fingerprint(*checkpoint);

  const RunDirectory exported = RunDirectory::create(to);
  write_networks(exported, *networks);
  write_file(exported.config(), read_file(trained.config()));
  write_file(exported.manifest(), manifest.dump(2) + "\n");
}

}  // namespace corridor::cluster
