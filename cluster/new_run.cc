#include "cluster/new_run.h"

#include "proto/system/files.h"
#include "scenarios/sumo_files.h"

namespace corridor::cluster {

NewRun::~NewRun() {
  std::error_code ignored;
  if (!kept_) std::filesystem::remove_all(directory_.root(), ignored);
}

void NewRun::fill(const RunConfig& config, const std::string& config_toml,
                  const RunManifest& manifest) const {
  scenarios::write_sumo_files(config, directory_.network().parent_path());
  for (const auto& file : {directory_.network(), directory_.routes()}) sync_file(file);
  write_file(directory_.config(), config_toml);
  write_manifest(directory_, manifest);
}

}  // namespace corridor::cluster
