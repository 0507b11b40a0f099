// SPDX-License-Identifier: Apache-2.0
#include "proto/run/episode_trace.h"

#include "proto/base/failure.h"

namespace corridor {

void to_json(Json& json, const TracedVehicle& vehicle) {
  json = {vehicle.id,       vehicle.s_m,     vehicle.d_m,    vehicle.speed_mps,
          vehicle.length_m, vehicle.width_m, vehicle.yaw_rad};
}

void from_json(const Json& json, TracedVehicle& vehicle) {
  if (!json.is_array() || json.size() != 7) throw Failure("a vehicle has seven numbers");
  vehicle = {whole_number<int>(json[0]), json[1].get<double>(), json[2].get<double>(),
             json[3].get<double>(),      json[4].get<double>(), json[5].get<double>(),
             json[6].get<double>()};
}

void EpisodeTrace::check() const {
  if (steps.empty()) throw Failure("no step");
  for (const TracedStep& step : steps) {
    if (step.command && static_cast<std::size_t>(*step.command) >= commands.size()) {
      throw Failure("an unknown command");
    }
    if (!step.decision) continue;
    if (step.decision->path_s_m.size() != step.decision->path_d_m.size()) {
      throw Failure("half a path");
    }
    const std::size_t values = step.decision->bp_values.size();
    if (values != 0 && values != commands.size()) throw Failure("values of other commands");
  }
}

const std::string& EpisodeTrace::command_name(int command) const {
  const auto place = static_cast<std::size_t>(command);
  CORRIDOR_CHECK(place < commands.size(), "command {} of {}", command, commands.size());
  return commands[place];
}

}  // namespace corridor
