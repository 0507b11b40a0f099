#include "proto/config_checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "proto/failure.h"

namespace corridor {
namespace {

struct Contradiction {
  const char* name;
  std::function<void(RunConfig&)> make;
  const char* text;
};

DqnSettings& mop(RunConfig& config) { return config.dqn[0]; }
DqnSettings& bp(RunConfig& config) { return config.dqn[1]; }

const std::vector<Contradiction>& contradictions() {
  static const std::vector<Contradiction> list = {
      {"lane width", [](RunConfig& c) { c.road.lane_width_m = 3.3; },
       "road.lane_width_m = 3.3 is no multiple of simulation.lateral_resolution_m = 0.8"},
      {"ego width", [](RunConfig& c) { c.ego.width_m = 3.2; }, "ego.width_m = 3.2"},
      {"road too short", [](RunConfig& c) { c.road.length_m = 14339.0; },
       "road.length_m = 14339 is too short for an episode at the speed limit: 14340 are needed"},
      {"episode too long", [](RunConfig& c) { c.simulation.episode_steps = 1500; },
       "road.length_m = 20000 is too short"},
      {"vehicles", [](RunConfig& c) { c.traffic.vehicles_min = 16; },
       "traffic.vehicles_min = 16 is above traffic.vehicles_max = 15"},
      {"factor min", [](RunConfig& c) { c.traffic.speed_factor_min = 0.9; },
       "traffic.speed_factor_min = 0.9 is above"},
      {"factor max", [](RunConfig& c) { c.traffic.speed_factor_max = 0.7; },
       "is above traffic.speed_factor_max = 0.7"},
      {"shares", [](RunConfig& c) { c.traffic.slow_share = 0.95; },
       "traffic.slow_share = 0.95 and traffic.truck_share = 0.1"},
      {"even corridors", [](RunConfig& c) { c.planner.corridors_per_lane = 4; },
       "planner.corridors_per_lane = 4 must be odd"},
      {"descending",
       [](RunConfig& c) {
         c.planner.speed_changes_mps = {1.0, 0.0};
       },
       "planner.speed_changes_mps = [1.0, 0.0] must be ascending"},
      {"repeated",
       [](RunConfig& c) {
         c.planner.speed_changes_mps = {1.0, 1.0};
       },
       "must be ascending, without repetition"},
      {"near", [](RunConfig& c) { c.mop_reward.near_low = 2.0; }, "mop_reward.near_low = 2"},
      {"thresholds", [](RunConfig& c) { c.road.lanes = 4; },
       "bp_reward.thresholds_mps has 3 values where road.lanes = 4"},
      {"hold", [](RunConfig& c) { c.random_bp.hold_steps_max = 39; },
       "random_bp.hold_steps_min = 40 is above"},
      {"capacity", [](RunConfig& c) { mop(c).capacity = 4999; }, "mop.capacity = 4999"},
      {"minimum", [](RunConfig& c) { bp(c).minimum_size = 63; }, "bp.minimum_size = 63"},
      {"rate", [](RunConfig& c) { bp(c).learning_rate_end = 1e-3; },
       "bp.learning_rate_end = 0.001 is above bp.learning_rate = 0.0005"},
      {"epsilon", [](RunConfig& c) { mop(c).epsilon = 0.01; },
       "mop.epsilon_end = 0.02 is above mop.epsilon = 0.01"},
      {"network",
       [](RunConfig& c) {
         mop(c).hidden = {4096, 4096};
       },
       "parameters: at most 16777216"},
      {"seeds",
       [](RunConfig& c) {
         c.evaluation.seeds = {3, 4, 3};
       },
       "evaluation.seeds = [3, 4, 3] has one twice"},
      {"ports", [](RunConfig& c) { c.run.learner_port = 5701; },
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
      ADD_FAILURE() << contradiction.name << " was accepted";
    } catch (const Failure& failure) {
      EXPECT_THAT(failure.what(), testing::StartsWith("test.toml: ")) << contradiction.name;
      EXPECT_THAT(failure.what(), testing::HasSubstr(contradiction.text)) << contradiction.name;
    }
  }
}

TEST(ConfigChecks, LaneWidthsThatOnlyRoundingSetsApartFromAMultipleAreFine) {
  RunConfig config;
  config.road.lane_width_m = 3.3;
  config.simulation.lateral_resolution_m = 1.1;  // 3.3 / 1.1 is not 3 in binary
  EXPECT_NO_THROW(check_config(config, "x"));
}

}  // namespace
}  // namespace corridor
