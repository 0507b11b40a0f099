// SPDX-License-Identifier: Apache-2.0
#include "proto/run/hindsight_record.h"

#include "proto/base/failure.h"
#include "proto/run/json_record.h"
#include "proto/system/files.h"

namespace corridor {

void HindsightLimits::check() const {
  if (actions < 1 || actions > kActionsMax || attempts_max < 1) {
    throw Failure("{} actions and {} attempts: 1 to {} actions and at least one attempt are needed",
                  actions, attempts_max, kActionsMax);
  }
}

void HindsightRecord::check() const {
  if (steps < 1) throw Failure("{} steps", steps);
  limits.check();
  for (const CollisionHindsight& collision : collisions) {
    if (collision.by_last_actions.size() != static_cast<std::size_t>(limits.actions)) {
      throw Failure("{} verdicts by the last {} actions", collision.by_last_actions.size(),
                    limits.actions);
    }
  }
}

void write_hindsight(const RunDirectory& directory, const HindsightRecord& record) {
  create_folders(directory.hindsight());
  write_file(directory.hindsight({record.planner, record.seed}), json_of(record).dump(1) + "\n");
}

HindsightRecord read_hindsight(const std::filesystem::path& file) {
  return parse_record<HindsightRecord>(read_json(file), file.string(), "hindsight");
}

}  // namespace corridor
