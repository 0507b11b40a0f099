// SPDX-License-Identifier: Apache-2.0
#include "proto/run/recorded_episode.h"

#include "proto/base/failure.h"
#include "proto/run/json_record.h"
#include "proto/system/files.h"

namespace corridor {

void RecordedEpisode::check() const {
  if (!driven_by_world && actions.size() != static_cast<std::size_t>(summary.steps)) {
    throw Failure("{} actions for {} steps", actions.size(), summary.steps);
  }
}

void write_recorded_episode(const RunDirectory& directory, const RecordedEpisode& episode) {
  write_file(directory.episode(episode.name()), json_of(episode).dump());
}

RecordedEpisode read_recorded_episode(const std::filesystem::path& file) {
  return parse_record<RecordedEpisode>(read_json(file), file.string(), "recorded episode");
}

}  // namespace corridor
