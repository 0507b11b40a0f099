// SPDX-License-Identifier: Apache-2.0
#include "proto/config/config_checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "proto/base/failure.h"

namespace corridor {
namespace {

struct Contradiction {
  std::function<void(RunConfig&)> make;
  const char* text;
};

DqnSettings& mop(RunConfig& config) { return config.dqn[0]; }
DqnSettings& bp(RunConfig& config) { return config.dqn[1]; }

const std::vector<Contradiction>& contradictions() {
  // Each sets all that it names: the defaults are tuned.
  static const std::vector<Contradiction> list = {
      {[](RunConfig& c) { c.road.lane_width_m = 3.3, c.simulation.lateral_resolution_m = 0.8; },
       "road.lane_width_m = 3.3 is no multiple of simulation.lateral_resolution_m = 0.8"},
      {[](RunConfig& c) { c.ego.width_m = c.road.lane_width_m; }, "ego.width_m = "},
      {[](RunConfig& c) {
         c.simulation = {.step_s = 1.0, .episode_steps = 1000, .lateral_resolution_m = 0.8};
         c.road = {.lanes = 3, .lane_width_m = 3.2, .length_m = 10449.0, .speed_limit_mps = 10.0};
         c.traffic.window_m = 125.0;
       },
       "road.length_m = 10449 is too short for an episode at the speed limit: 10450 are needed"},
      {[](RunConfig& c) { c.simulation.step_s = 1.0, c.simulation.substeps = 3; },
       "simulation.step_s = 1 in simulation.substeps = 3 is no whole number of milliseconds"},
      {[](RunConfig& c) {
         c.simulation.step_s = 1.0, c.simulation.substeps = 8, c.dynamics.world = WorldKind::kSlip;
       },
       "simulation.step_s = 1 in simulation.substeps = 8 is no multiple of 0.05"},
      {[](RunConfig& c) { c.dynamics.actuation_delay_s = 0.12; },
       "dynamics.actuation_delay_s = 0.12 is no multiple of 0.05"},
      {[](RunConfig& c) { c.traffic.vehicles_min = 16, c.traffic.vehicles_max = 15; },
       "traffic.vehicles_min = 16 is above traffic.vehicles_max = 15"},
      {[](RunConfig& c) { c.traffic.speed_factor_min = 0.9, c.traffic.speed_factor_mean = 0.8; },
       "traffic.speed_factor_min = 0.9 is above traffic.speed_factor_mean = 0.8"},
      {[](RunConfig& c) { c.traffic.speed_factor_mean = 0.8, c.traffic.speed_factor_max = 0.7; },
       "traffic.speed_factor_mean = 0.8 is above traffic.speed_factor_max = 0.7"},
      {[](RunConfig& c) { c.traffic.slow_share = 0.95, c.traffic.truck_share = 0.1; },
       "traffic.slow_share = 0.95 and traffic.truck_share = 0.1"},
      {[](RunConfig& c) {
         c.road.lane_width_m = 3.2, c.ego.width_m = 1.8, c.planner.side_clearance_m = 0.15;
         c.planner.corridors_per_lane = 5;
         c.traffic.objects_per_km = 3.0, c.traffic.object_width_m = 1.2;
       },
       "traffic.object_width_m = 1.2 leaves the ego no corridor to go around in its lane: at most "
       "1.18 do"},
      {[](RunConfig& c) {
         c.road.speed_limit_mps = 12.0, c.simulation.step_s = 1.0, c.ego.length_m = 5.0;
         c.traffic.objects_per_km = 3.0, c.traffic.object_length_m = 6.9;
       },
       "traffic.object_length_m = 6.9 is so short that the ego can jump over it in a step of 1 s: "
       "at "
       "least 7.00 is needed"},
      {[](RunConfig& c) { c.training_traffic.vehicles = {9}; },
       "training_traffic.vehicles = [9] is neither [low, high] nor []"},
      {[](RunConfig& c) {
         c.training_traffic.blind_rate_per_s = {0.02, 0.01};
       },
       "training_traffic.blind_rate_per_s = [0.02, 0.01] is neither [low, high] nor []"},
      {[](RunConfig& c) {
         c.traffic.truck_share = 0.1, c.training_traffic.slow_share = {0.2, 0.95};
       },
       "training_traffic.slow_share = [0.2, 0.95] and traffic.truck_share = 0.1 can be more"},
      {[](RunConfig& c) {
         c.traffic.speed_factor_min = 0.4, c.training_traffic.speed_factor_mean = {0.3, 0.8};
       },
       "training_traffic.speed_factor_mean = [0.3, 0.8] reaches beyond traffic.speed_factor_min"},
      {[](RunConfig& c) {
         c.training_traffic.objects_per_km = {0.0, 3.0}, c.traffic.object_width_m = 2.0;
       },
       "traffic.object_width_m = 2 leaves the ego no corridor"},
      {[](RunConfig& c) { c.planner.corridors_per_lane = 4; },
       "planner.corridors_per_lane = 4 must be odd"},
      {[](RunConfig& c) {
         c.planner.speed_changes_mps = {1.0, 0.0};
       },
       "planner.speed_changes_mps = [1.0, 0.0] must be ascending"},
      {[](RunConfig& c) {
         c.planner.speed_changes_mps = {1.0, 1.0};
       },
       "must be ascending, without repetition"},
      {[](RunConfig& c) { c.mop_reward.near_low = 2.0, c.mop_reward.near_high = 1.5; },
       "mop_reward.near_low = 2 is above mop_reward.near_high = 1.5"},
      {[](RunConfig& c) {
         c.road.lanes = 4, c.bp_reward.thresholds_mps = {1, 2, 3};
       },
       "bp_reward.thresholds_mps has 3 values where road.lanes = 4"},
      {[](RunConfig& c) { c.random_bp.hold_steps_min = 40, c.random_bp.hold_steps_max = 39; },
       "random_bp.hold_steps_min = 40 is above random_bp.hold_steps_max = 39"},
      {[](RunConfig& c) { mop(c).capacity = mop(c).minimum_size - 1; }, "mop.capacity = "},
      {[](RunConfig& c) { bp(c).minimum_size = bp(c).batch_size - 1; }, "bp.minimum_size = "},
      {[](RunConfig& c) { bp(c).learning_rate = 5e-4, bp(c).learning_rate_end = 1e-3; },
       "bp.learning_rate_end = 0.001 is above bp.learning_rate = 0.0005"},
      {[](RunConfig& c) { mop(c).epsilon = 0.01, mop(c).epsilon_end = 0.02; },
       "mop.epsilon_end = 0.02 is above mop.epsilon = 0.01"},
      {[](RunConfig& c) {
         mop(c).hidden = {4096, 4096};
       },
       "mop.hidden = [4096, 4096] makes a planner"},
      {[](RunConfig& c) {
         c.evaluation.seeds = {3, 4, 3};
       },
       "evaluation.seeds = [3, 4, 3] has one twice"},
      {[](RunConfig& c) { c.run.replay_port = c.run.learner_port = 5701; },
       "run.replay_port and run.learner_port are both 5701"},
  };
  return list;
}

TEST(ConfigChecks, TheDefaultsFitEachOther) { EXPECT_NO_THROW(check_config({}, "x")); }

TEST(ConfigChecks, ContradictionsAreNamed) {
  for (const Contradiction& contradiction : contradictions()) {
    RunConfig config;
    contradiction.make(config);
    try {
      check_config(config, "test.toml");
      ADD_FAILURE() << "accepted, not: " << contradiction.text;
    } catch (const Failure& failure) {
      EXPECT_THAT(failure.what(), testing::StartsWith("test.toml: "));
      EXPECT_THAT(failure.what(), testing::HasSubstr(contradiction.text));
    }
  }
}

TEST(ConfigChecks, ObjectsThatLeaveJustRoomAreFineAndSoAreAnyWhereThereAreNone) {
  RunConfig config;
  config.traffic.objects_per_km = 3.0;
  config.traffic.object_width_m = 1.18;
  EXPECT_NO_THROW(check_config(config, "x"));
  config.traffic.objects_per_km = 0.0;
  config.traffic.object_width_m = 3.0;
  EXPECT_NO_THROW(check_config(config, "x"));
}

TEST(ConfigChecks, LaneWidthsThatOnlyRoundingSetsApartFromAMultipleAreFine) {
  RunConfig config;
  config.road.lane_width_m = 3.3;
  config.simulation.lateral_resolution_m = 1.1;  // 3.3 / 1.1 is not 3 in binary
  EXPECT_NO_THROW(check_config(config, "x"));
}

}  // namespace
}  // namespace corridor
