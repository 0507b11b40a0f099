// SPDX-License-Identifier: Apache-2.0
#include "cluster/check.h"

#include "proto/base/failure.h"
#include "proto/base/text.h"
#include "proto/config/doubts.h"
#include "proto/config/run_config.h"
#include "proto/settings/schedule.h"
#include "proto/system/files.h"
#include "scenarios/sumo_files.h"

namespace corridor::cluster {
namespace {

std::string phase_line(const RunConfig& config, const Schedule& schedule, Phase phase) {
  const DqnSettings& dqn = config.phase(phase);
  const PlannerShape shape = config.shape(phase);
  const std::size_t stride = RowLayout{shape.observations}.stride();
  const double memory_mib =
      static_cast<double>(dqn.capacity) * static_cast<double>(stride * sizeof(float)) / 1048576.0;
  return fmt::format(
      "  {:<11} {} steps in {} rounds; {} observations, {} actions; replay of {} rows, {:.0f} "
      "MiB\n",
      phase_name(phase), grouped(dqn.steps),
      grouped(static_cast<std::int64_t>(schedule.rounds_of(phase))), shape.observations,
      shape.actions, grouped(dqn.capacity), memory_mib);
}

std::string summary(const RunConfig& config) {
  const Schedule schedule(config);
  const RoadSettings& road = config.road;
  const TrafficSettings& traffic = config.traffic;
  std::string phases;
  for (const NamedNetwork& network : kNetworks) {
    phases += phase_line(config, schedule, network.id);
  }
  return fmt::format(
             "  road        {} lanes of {} m, {:.1f} km, {:.0f} km/h\n"
             "  traffic     {} to {} vehicles within {:.0f} m; {:.0f} % slow, {:.0f} % trucks; "
             "{} blind drivers a second; {} objects per km\n"
             "  time        steps of {} s, episodes of {}; {} actors, rounds of {} steps each\n",
             road.lanes, road.lane_width_m, road.length_m / 1000.0,
             kKphPerMps * road.speed_limit_mps, traffic.vehicles_min, traffic.vehicles_max,
             traffic.window_m, 100.0 * traffic.slow_share, 100.0 * traffic.truck_share,
             traffic.blind_rate_per_s, traffic.objects_per_km, config.simulation.step_s,
             config.simulation.episode_steps, config.run.actors, config.schedule.steps_per_round) +
         phases +
         fmt::format("  evaluation  {} steps for each planner, {} seed{}\n",
                     grouped(config.evaluation.steps), config.evaluation.seeds.size(),
                     config.evaluation.seeds.size() == 1 ? "" : "s");
}

}  // namespace

int check(const std::filesystem::path& scenario, const std::vector<std::string>& settings) {
  const RunConfig config = load_run_config(scenario, settings);
  const NewFolder never_kept(std::filesystem::temp_directory_path() / "corridor-check");
  scenarios::write_sumo_files(config, never_kept.path());
  fmt::print("{}: ok\n{}", scenario.string(), summary(config));
  for (const std::string& doubt : doubts_about(config)) fmt::print("  warning     {}\n", doubt);
  return 0;
}

}  // namespace corridor::cluster
