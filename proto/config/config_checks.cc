// SPDX-License-Identifier: Apache-2.0
#include "proto/config/config_checks.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "proto/base/failure.h"
#include "proto/config/toml_text.h"
#include "proto/settings/limits.h"

namespace corridor {
namespace {

constexpr std::size_t kParametersMax = kDataBytesMax / sizeof(float);

// Left free at the road's ends, beyond the traffic's window.
constexpr double kRoadEnds_m = 200.0;

template <typename... Args>
void require(bool condition, fmt::format_string<Args...> text, Args&&... args) {
  if (!condition) throw Failure(text, std::forward<Args>(args)...);
}

bool is_multiple(double value, double unit) {
  const double ratio = value / unit;
  return std::abs(ratio - std::round(ratio)) < 1e-6;
}

template <typename T>
void require_ordered(const char* low_key, T low, const char* high_key, T high) {
  require(low <= high, "{} = {} is above {} = {}", low_key, low, high_key, high);
}

template <typename T>
bool is_ascending(const std::vector<T>& values) {
  return std::adjacent_find(values.begin(), values.end(), std::greater_equal<T>()) == values.end();
}

void check_road(const RunConfig& config) {
  const RoadSettings& road = config.road;
  const SimulationSettings& simulation = config.simulation;
  require(is_multiple(road.lane_width_m, simulation.lateral_resolution_m),
          "road.lane_width_m = {} is no multiple of simulation.lateral_resolution_m = {}",
          road.lane_width_m, simulation.lateral_resolution_m);
  require(config.ego.width_m < road.lane_width_m,
          "ego.width_m = {} must be below road.lane_width_m = {}", config.ego.width_m,
          road.lane_width_m);
  const double needed_m = simulation.episode_steps * simulation.step_s * road.speed_limit_mps +
                          2 * config.traffic.window_m + kRoadEnds_m;
  require(road.length_m >= needed_m,
          "road.length_m = {} is too short for an episode at the speed limit: {} are needed, or "
          "fewer simulation.episode_steps",
          road.length_m, std::ceil(needed_m));
}

// SUMO's clock counts in milliseconds, and the ego's controller in periods (actor/world).
void check_clock(const RunConfig& config) {
  const SimulationSettings& simulation = config.simulation;
  const DynamicsSettings& dynamics = config.dynamics;
  require(is_multiple(simulation.substep_s(), 0.001),
          "simulation.step_s = {} in simulation.substeps = {} is no whole number of milliseconds",
          simulation.step_s, simulation.substeps);
  require(is_multiple(dynamics.actuation_delay_s, kControlPeriod_s),
          "dynamics.actuation_delay_s = {} is no multiple of {}", dynamics.actuation_delay_s,
          kControlPeriod_s);
  require(dynamics.world == WorldKind::kKinematic ||
              is_multiple(simulation.substep_s(), kControlPeriod_s),
          "simulation.step_s = {} in simulation.substeps = {} is no multiple of {}, as "
          "dynamics.world = \"{}\" needs",
          simulation.step_s, simulation.substeps, kControlPeriod_s, name_of(dynamics.world));
}

void check_traffic(const TrafficSettings& traffic) {
  require_ordered("traffic.vehicles_min", traffic.vehicles_min, "traffic.vehicles_max",
                  traffic.vehicles_max);
  require_ordered("traffic.speed_factor_min", traffic.speed_factor_min, "traffic.speed_factor_mean",
                  traffic.speed_factor_mean);
  require_ordered("traffic.speed_factor_mean", traffic.speed_factor_mean,
                  "traffic.speed_factor_max", traffic.speed_factor_max);
  require(traffic.slow_share + traffic.truck_share <= 1.0,
          "traffic.slow_share = {} and traffic.truck_share = {} are more than all",  //
          traffic.slow_share, traffic.truck_share);
}

template <typename T>
void require_range(const char* key, const std::vector<T>& range) {
  require(range.empty() || (range.size() == 2 && range[0] <= range[1]),
          "training_traffic.{} = {} is neither [low, high] nor []", key, toml_of(range));
}

// Whatever an episode draws must satisfy what [traffic] must.
void check_training_traffic(const TrafficSettings& traffic, const TrafficDistribution& training) {
  require_range("vehicles", training.vehicles);
  require_range("slow_share", training.slow_share);
  require_range("speed_factor_mean", training.speed_factor_mean);
  require_range("blind_rate_per_s", training.blind_rate_per_s);
  require_range("objects_per_km", training.objects_per_km);
  if (!training.slow_share.empty()) {
    require(training.slow_share[1] + traffic.truck_share <= 1.0,
            "training_traffic.slow_share = {} and traffic.truck_share = {} can be more than all",
            toml_of(training.slow_share), traffic.truck_share);
  }
  for (const double mean : training.speed_factor_mean) {
    require(mean >= traffic.speed_factor_min && mean <= traffic.speed_factor_max,
            "training_traffic.speed_factor_mean = {} reaches beyond traffic.speed_factor_min = {} "
            "or traffic.speed_factor_max = {}",
            toml_of(training.speed_factor_mean), traffic.speed_factor_min,
            traffic.speed_factor_max);
  }
}

// An object at one edge of a lane must leave clear the corridor furthest from it that the ego may
// use without intruding on the next lane.
void check_objects(const RunConfig& config) {
  const TrafficSettings& traffic = config.traffic;
  const auto& training = config.training_traffic.objects_per_km;
  if (traffic.objects_per_km == 0.0 && (training.empty() || training[1] == 0.0)) return;
  const double corridor_m = config.road.lane_width_m / config.planner.corridors_per_lane;
  const double off_middle_m = (config.road.lane_width_m - config.ego.width_m) / 2;
  const double last_centre_m =
      config.road.lane_width_m / 2 + std::floor(off_middle_m / corridor_m + 1e-9) * corridor_m;
  const double room_m = last_centre_m - config.ego.width_m / 2 - config.planner.side_clearance_m;
  require(
      traffic.object_reach_m() <= room_m,
      "traffic.object_width_m = {} leaves the ego no corridor to go around in its lane: at most "
      "{:.2f} do",
      traffic.object_width_m, std::max(0.0, room_m - TrafficSettings::kObjectMargin_m));
  // Collisions are looked for at the end of each step.
  const double step_m = config.road.speed_limit_mps * config.simulation.substep_s();
  require(traffic.object_length_m + config.ego.length_m >= step_m,
          "traffic.object_length_m = {} is so short that the ego can jump over it in a step of {} "
          "s: at least {:.2f} is needed",
          traffic.object_length_m, config.simulation.substep_s(), step_m - config.ego.length_m);
}

void check_planners(const RunConfig& config) {
  require(config.planner.corridors_per_lane % 2 == 1,
          "planner.corridors_per_lane = {} must be odd, so that there is a middle",
          config.planner.corridors_per_lane);
  require(is_ascending(config.planner.speed_changes_mps),
          "planner.speed_changes_mps = {} must be ascending, without repetition",
          toml_of(config.planner.speed_changes_mps));
  require_ordered("mop_reward.near_low", config.mop_reward.near_low, "mop_reward.near_high",
                  config.mop_reward.near_high);
  require(config.bp_reward.thresholds_mps.size() == static_cast<std::size_t>(config.road.lanes),
          "bp_reward.thresholds_mps has {} values where road.lanes = {}: give one a lane",
          config.bp_reward.thresholds_mps.size(), config.road.lanes);
  require_ordered("random_bp.hold_steps_min", config.random_bp.hold_steps_min,
                  "random_bp.hold_steps_max", config.random_bp.hold_steps_max);
}

void check_dqn(const RunConfig& config, Phase phase) {
  const DqnSettings& dqn = config.phase(phase);
  const char* const table = named_network(phase).name;
  require(dqn.capacity >= dqn.minimum_size && dqn.minimum_size >= dqn.batch_size,
          "{0}.capacity = {1}, {0}.minimum_size = {2}, {0}.batch_size = {3} must not ascend", table,
          dqn.capacity, dqn.minimum_size, dqn.batch_size);
  require(dqn.learning_rate_end <= dqn.learning_rate,
          "{0}.learning_rate_end = {1} is above {0}.learning_rate = {2}", table,
          dqn.learning_rate_end, dqn.learning_rate);
  require(dqn.epsilon_end <= dqn.epsilon, "{0}.epsilon_end = {1} is above {0}.epsilon = {2}", table,
          dqn.epsilon_end, dqn.epsilon);
  const std::size_t parameters = config.parameters(phase);
  require(parameters <= kParametersMax,
          "{}.hidden = {} makes a planner of {} parameters: at most {} fit a message", table,
          toml_of(dqn.hidden), parameters, kParametersMax);
}

void check_run(const RunConfig& config) {
  const auto& seeds = config.evaluation.seeds;
  require(std::set<std::uint64_t>(seeds.begin(), seeds.end()).size() == seeds.size(),
          "evaluation.seeds = {} has one twice", toml_of(seeds));
  require(config.run.replay_port != config.run.learner_port,
          "run.replay_port and run.learner_port are both {}", config.run.replay_port);
}

}  // namespace

void check_config(const RunConfig& config, const std::string& name) {
  try {
    check_road(config);
    check_clock(config);
    check_traffic(config.traffic);
    check_training_traffic(config.traffic, config.training_traffic);
    check_planners(config);
    check_objects(config);
    for (const NamedNetwork& network : kNetworks) check_dqn(config, network.id);
    check_run(config);
  } catch (const Failure& failure) {
    throw Failure("{}: {}", name, failure.what());
  }
}

}  // namespace corridor
