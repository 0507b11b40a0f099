// SPDX-License-Identifier: Apache-2.0
#include "actor/world/sumo_world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "actor/driving/bypass.h"
#include "proto/base/failure.h"
#include "proto/base/hash.h"
#include "proto/settings/collision_kinds.h"
#include "proto/settings/sumo_names.h"
#include "scenarios/sumo_files.h"
#include "tests/support/temporary_directory.h"

namespace corridor::world {
namespace {

namespace fs = std::filesystem;
using driving::Scene;
using driving::Vehicle;
using testing::HasSubstr;
using testing_support::TemporaryDirectory;

class SumoWorldTest : public testing::Test {
 protected:
  SumoWorldTest() { scenarios::write_sumo_files(config_, directory_.path()); }

  fs::path network() const { return directory_.path() / kSumoNetworkFile; }
  fs::path types() const { return directory_.path() / kSumoRoutesFile; }
  SumoWorld make() { return SumoWorld(world_settings(config_), network(), types(), time_); }

  // An ego that weaves over all lanes at changing speeds.
  driving::Trajectory weave(const Scene& scene, int step) const {
    const driving::Target target{1 + (step / 7 * 4) % 13, 8.0 + (step / 11) % 5};
    return {scene.ego, target, driving_settings(config_)};
  }

  // Drives on through collisions.
  std::uint64_t drive(SumoWorld& world, std::uint64_t seed, EgoDriver driver, int steps) const {
    Hash hash;
    const auto add = [&](const Scene& scene) {
      const driving::Ego& ego = scene.ego;
      for (const double value : {ego.s_m, ego.d_m, ego.speed_mps, ego.lateral_speed_mps}) {
        hash.add_value(value);
      }
      for (const Vehicle& other : scene.others) {
        hash.add_value(other.id);
        for (const double value : {other.s_m, other.d_m, other.speed_mps, other.lateral_speed_mps,
                                   other.length_m, other.width_m}) {
          hash.add_value(value);
        }
      }
    };
    Scene scene = world.begin({seed, driver, {}});
    add(scene);
    for (int step = 0; step < steps; ++step) {
      scene = driver == EgoDriver::kWorld ? world.step_by_world().scene
                                          : world.step(weave(scene, step)).scene;
      add(scene);
    }
    return hash.value();
  }

  TemporaryDirectory directory_;
  RunConfig config_;
  TimeAccount time_;
};

// Run by the test below, in a process of its own.
TEST_F(SumoWorldTest, DISABLED_PrintsWhatItDrove) {
  SumoWorld world = make();
  for (const std::uint64_t seed : {11, 12}) {
    std::printf("drove %016lx %016lx\n", drive(world, seed, EgoDriver::kPlanner, 300),
                drive(world, seed, EgoDriver::kWorld, 300));
  }
}

std::string drive_in_another_process() {
  const std::string command = "'" + fs::read_symlink("/proc/self/exe").string() +
                              "' --gtest_also_run_disabled_tests"
                              " --gtest_filter=SumoWorldTest.DISABLED_PrintsWhatItDrove";
  FILE* pipe = popen(command.c_str(), "r");
  std::string text;
  char line[256];
  while (std::fgets(line, sizeof line, pipe) != nullptr) {
    if (std::string_view(line).starts_with("drove")) text += line;
  }
  EXPECT_EQ(pclose(pipe), 0);
  return text;
}

TEST_F(SumoWorldTest, DrivesEqualEpisodesBitForBitInAnyProcessAndAfterAnyOthers) {
  const std::string elsewhere = drive_in_another_process();
  SumoWorld world = make();
  drive(world, 99, EgoDriver::kWorld, 120);
  drive(world, 98, EgoDriver::kPlanner, 350);
  world.end();
  std::string here;
  for (const std::uint64_t seed : {11, 12}) {
    const std::uint64_t by_world = drive(world, seed, EgoDriver::kWorld, 300);
    drive(world, 97, EgoDriver::kPlanner, 20);
    const std::uint64_t by_planner = drive(world, seed, EgoDriver::kPlanner, 300);
    here += fmt::format("drove {:016x} {:016x}\n", by_planner, by_world);
  }
  EXPECT_EQ(here, elsewhere);
}

TEST_F(SumoWorldTest, DrivesOtherEpisodesForOtherSeeds) {
  SumoWorld world = make();
  EXPECT_NE(drive(world, 1, EgoDriver::kWorld, 50), drive(world, 2, EgoDriver::kWorld, 50));
}

TEST_F(SumoWorldTest, PutsTheEgoExactlyWhereItsTrajectoryLeads) {
  SumoWorld world = make();
  Scene scene = world.begin({5, EgoDriver::kPlanner, {}});
  for (int step = 0; step < 200; ++step) {
    const driving::Trajectory trajectory = weave(scene, step);
    const driving::TrajectoryPoint point = trajectory.at(config_.simulation.step_s);
    const double speed_before_mps = scene.ego.speed_mps;
    scene = world.step(trajectory).scene;
    EXPECT_EQ(scene.ego.s_m, point.s_m);
    EXPECT_EQ(scene.ego.d_m, point.d_m);
    EXPECT_EQ(scene.ego.speed_mps, point.speed_mps);
    // Over the whole step: the trajectory's own is 0 once the set-point is reached.
    EXPECT_DOUBLE_EQ(scene.ego.acceleration_mps2,
                     (point.speed_mps - speed_before_mps) / config_.simulation.step_s);
    EXPECT_EQ(scene.ego.set_point_mps, trajectory.target().set_point_mps);
  }
}

TEST_F(SumoWorldTest, ShowsEveryoneOnTheRoadWithinTheWindowAscendingById) {
  SumoWorld world = make();
  Scene scene = world.begin({6, EgoDriver::kWorld, {}});
  double others = 0.0;
  for (int step = 0; step < 300; ++step) {
    scene = world.step_by_world().scene;
    others += static_cast<double>(scene.others.size());
    EXPECT_LE(scene.others.size(), static_cast<std::size_t>(config_.traffic.vehicles_max));
    int last_id = 0;
    for (const Vehicle& vehicle : scene.others) {
      EXPECT_GT(vehicle.id, last_id);
      last_id = vehicle.id;
      EXPECT_LE(std::abs(vehicle.s_m - scene.ego.s_m), 125.0 + 1e-9);
      EXPECT_GE(vehicle.d_m, vehicle.width_m / 2 - 0.01);
      EXPECT_LE(vehicle.d_m, 9.6 - vehicle.width_m / 2 + 0.01);
      EXPECT_GE(vehicle.speed_mps, 0.0);
    }
  }
  EXPECT_GE(others / 300, config_.traffic.vehicles_min - 1.5);  // some wait for room
}

TEST_F(SumoWorldTest, ShowsEachVehicleMovedByItsSpeedsOverTheLastStep) {
  SumoWorld world = make();
  Scene before = world.begin({7, EgoDriver::kPlanner, {}});
  int sideways = 0;
  for (int step = 0; step < 300; ++step) {
    const Scene after = world.step(weave(before, step)).scene;
    for (const Vehicle& now : after.others) {
      for (const Vehicle& then : before.others) {
        if (then.id != now.id) continue;
        EXPECT_NEAR(now.s_m - then.s_m, now.speed_mps, 1e-6);
        EXPECT_NEAR(now.d_m - then.d_m, now.lateral_speed_mps, 1e-6);
        sideways += std::abs(now.lateral_speed_mps) > 0.5 ? 1 : 0;
      }
    }
    before = after;
  }
  EXPECT_GT(sideways, 50);
}

TEST_F(SumoWorldTest, TrafficSeesTheEgoAndBrakesBehindIt) {
  config_.traffic.blind_rate_per_s = 0.0;
  SumoWorld world = make();
  Scene scene = world.begin({8, EgoDriver::kPlanner, {}});
  for (int step = 0; step < 200; ++step) {
    const int middle = 7;
    const StepResult result = world.step({scene.ego, {middle, 4.0}, driving_settings(config_)});
    // While the ego still changes lanes it may cut somebody off.
    if (step > 10) {
      EXPECT_FALSE(result.collision) << "step " << step;
    }
    scene = result.scene;
  }
}

TEST_F(SumoWorldTest, ReportsTheEgosCollisionWithAStandingLeader) {
  config_.traffic.slow_speed_factor = 0.2;
  config_.traffic.slow_share = 1.0;
  config_.traffic.truck_share = 0.0;
  SumoWorld world = make();
  Scene scene = world.begin({9, EgoDriver::kPlanner, {}});
  std::optional<driving::Collision> collision;
  for (int step = 0; step < 200 && !collision; ++step) {
    const StepResult result = world.step({scene.ego, {7, 13.8}, driving_settings(config_)});
    collision = result.collision;
    scene = result.scene;
  }
  ASSERT_TRUE(collision);
  EXPECT_EQ(collision->kind, CollisionKind::kRearEnding);
}

TEST_F(SumoWorldTest, DrivesTheEgoItselfFasterThanItsTrafficAndOverTheLanes) {
  SumoWorld world = make();
  Scene scene = world.begin({10, EgoDriver::kWorld, {}});
  const double start_s_m = scene.ego.s_m;
  std::array<int, 3> lanes = {};
  for (int step = 0; step < 300; ++step) {
    const Scene after = world.step_by_world().scene;
    EXPECT_NEAR(after.ego.s_m - scene.ego.s_m, after.ego.speed_mps, 1e-6);
    EXPECT_NEAR(after.ego.speed_mps - scene.ego.speed_mps, after.ego.acceleration_mps2, 1e-9);
    EXPECT_EQ(after.ego.set_point_mps, 0.0);
    ++lanes[static_cast<std::size_t>(after.ego.d_m / 3.2)];
    scene = after;
  }
  EXPECT_GT(scene.ego.s_m - start_s_m, 300 * 9.0);
  EXPECT_GE(std::count_if(lanes.begin(), lanes.end(), [](int steps) { return steps > 0; }), 2);
}

TEST_F(SumoWorldTest, DrivesAnEpisodeInItsOwnTraffic) {
  SumoWorld world = make();
  TrafficSettings few = config_.traffic;
  few.vehicles_min = few.vehicles_max = 3;
  EXPECT_LE(world.begin({.seed = 11, .traffic = few}).others.size(), 3u);
  EXPECT_GT(world.begin({.seed = 11}).others.size(), 6u);
}

TEST_F(SumoWorldTest, DrivesAStepInSeveralOfSumosOwn) {
  config_.simulation.substeps = 5;
  SumoWorld world = make();
  Scene before = world.begin({7, EgoDriver::kPlanner, {}});
  double way_m = 0.0, largest_change_m = 0.0;
  for (int step = 0; step < 100; ++step) {
    const driving::Trajectory trajectory = weave(before, step);
    const driving::TrajectoryPoint point = trajectory.at(1.0);
    const StepResult result = world.step(trajectory);
    if (result.collision) break;
    const Scene& after = result.scene;
    EXPECT_DOUBLE_EQ(after.ego.s_m, point.s_m);
    EXPECT_DOUBLE_EQ(after.ego.d_m, point.d_m);
    EXPECT_NEAR(after.ego.acceleration_mps2, point.speed_mps - before.ego.speed_mps, 1e-9);
    for (const Vehicle& now : after.others) {
      const Vehicle* then = find_vehicle(before, now.id);
      if (then == nullptr) continue;
      way_m += now.s_m - then->s_m;
      // Faster or slower within the step: not by the last speed alone.
      largest_change_m = std::max(largest_change_m, std::abs(now.s_m - then->s_m - now.speed_mps));
    }
    before = after;
  }
  EXPECT_GT(way_m, 1000.0);
  EXPECT_GT(largest_change_m, 0.01);
}

TEST_F(SumoWorldTest, StopsAStepWhereTheEgoCollides) {
  config_.simulation.substeps = 5;
  config_.traffic.slow_speed_factor = 0.2;
  config_.traffic.slow_share = 1.0;
  config_.traffic.truck_share = 0.0;
  SumoWorld world = make();
  double smallest_share = 1.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Scene scene = world.begin({seed, EgoDriver::kPlanner, {}});
    std::optional<driving::Collision> collision;
    for (int step = 0; step < 200 && !collision; ++step) {
      const driving::Trajectory ahead(scene.ego, {7, 13.8}, driving_settings(config_));
      const StepResult result = world.step(ahead);
      collision = result.collision;
      if (collision) {
        const double way_m = result.scene.ego.s_m - scene.ego.s_m;
        const double share = way_m / (ahead.at(1.0).s_m - scene.ego.s_m);
        smallest_share = std::min(smallest_share, share);
        EXPECT_LE(share, 1.0 + 1e-9);
      }
      scene = result.scene;
    }
    EXPECT_TRUE(collision);
  }
  EXPECT_LT(smallest_share, 0.5);
}

TEST_F(SumoWorldTest, DrivesACarWithDynamicsBitForBitAfterAnyOtherEpisodes) {
  config_.simulation.substeps = 5;
  for (const WorldKind kind : {WorldKind::kRigid, WorldKind::kSlip}) {
    config_.dynamics = {.world = kind, .position_noise_m = 0.1, .ghost = true};
    SumoWorld world = make();
    const std::uint64_t hash = drive(world, 21, EgoDriver::kPlanner, 60);
    drive(world, 22, EgoDriver::kPlanner, 45);
    drive(world, 23, EgoDriver::kWorld, 20);
    EXPECT_EQ(drive(world, 21, EgoDriver::kPlanner, 60), hash) << name_of(kind);
  }
}

// The ego straddles the line between the middle and the left lane, at walking pace: whoever comes
// up behind it in the left lane sees it if there is a ghost.
TEST_F(SumoWorldTest, AGhostMakesTrafficBrakeForWhatReachesIntoItsLane) {
  config_.simulation.substeps = 5;
  config_.traffic.blind_rate_per_s = 0.0;
  const auto collisions = [&](bool ghost) {
    config_.dynamics.ghost = ghost;
    SumoWorld world = make();
    int count = 0;
    for (std::uint64_t seed = 60; seed < 72; ++seed) {
      Scene scene = world.begin({seed, EgoDriver::kPlanner, {}});
      for (int step = 0; step < 60; ++step) {
        // Corridor 9 is the left one of the middle lane.
        const StepResult result = world.step({scene.ego, {9, 6.0}, driving_settings(config_)});
        scene = result.scene;
        if (!result.collision) continue;
        ++count;
        break;
      }
    }
    return count;
  };
  const int without = collisions(false), with = collisions(true);
  EXPECT_GE(without, 3);
  EXPECT_LT(with, without);
}

class SumoObjects : public SumoWorldTest {
 protected:
  SumoObjects() {
    config_.traffic.objects_per_km = 5.0;
    config_.traffic.blind_rate_per_s = 0.0;
    scenarios::write_sumo_files(config_, directory_.path());
  }
  bool is_object(const Vehicle& vehicle) const {
    return vehicle.width_m == config_.traffic.object_width_m;
  }
};

TEST_F(SumoObjects, StayAtTheEdgeWhereTheyWerePut) {
  SumoWorld world = make();
  Scene scene = world.begin({11, EgoDriver::kWorld, {}});
  std::map<int, Vehicle> seen;
  for (int step = 0; step < 300; ++step) {
    scene = world.step_by_world().scene;
    for (const Vehicle& vehicle : scene.others) {
      if (!is_object(vehicle)) continue;
      const Vehicle& first = seen.try_emplace(vehicle.id, vehicle).first->second;
      EXPECT_NEAR(vehicle.s_m, first.s_m, 1e-6);
      EXPECT_NEAR(vehicle.d_m, first.d_m, 1e-6) << step;
      EXPECT_EQ(vehicle.speed_mps, 0.0);
      EXPECT_EQ(vehicle.lateral_speed_mps, 0.0);
    }
  }
  EXPECT_GE(seen.size(), 10u);
}

TEST_F(SumoObjects, LeaveNothingToTheNextEpisodeWhenOneEndsAsTheyCome) {
  SumoWorld world = make();
  const std::uint64_t hash = drive(world, 20, EgoDriver::kPlanner, 200);
  for (std::uint64_t seed = 30; seed < 50; ++seed) {
    Scene scene = world.begin({seed, EgoDriver::kWorld, {}});
    while (std::ranges::none_of(scene.others, [&](const Vehicle& v) { return is_object(v); })) {
      scene = world.step_by_world().scene;
    }
    EXPECT_EQ(drive(world, 20, EgoDriver::kPlanner, 200), hash) << "after seed " << seed;
  }
}

// SUMO's drivers go around them within the lane, and nobody waits behind them for long.
TEST_F(SumoObjects, DoNotHoldUpTraffic) {
  SumoWorld world = make();
  Scene scene = world.begin({12, EgoDriver::kWorld, {}});
  int ego_bypasses = 0, drivers = 0, drivers_stopped = 0;
  for (int step = 0; step < 500; ++step) {
    const StepResult result = world.step_by_world();
    EXPECT_FALSE(result.collision) << "step " << step;
    ego_bypasses += driving::bypasses(scene, result.scene, driving_settings(config_));
    scene = result.scene;
    for (const Vehicle& vehicle : scene.others) {
      if (is_object(vehicle)) continue;
      ++drivers;
      drivers_stopped += vehicle.speed_mps < 1.0;
    }
  }
  EXPECT_GE(ego_bypasses, 3);
  EXPECT_GT(scene.ego.s_m, 500 * 9.0);
  EXPECT_LT(drivers_stopped, drivers / 100);
}

TEST_F(SumoObjects, CrawlAtTheSpeedSet) {
  config_.traffic.object_speed_mps = 2.5;
  SumoWorld world = make();
  Scene scene = world.begin({13, EgoDriver::kWorld, {}});
  std::map<int, Vehicle> before;
  int steps_seen = 0;
  double way_m = 0.0;
  for (int step = 0; step < 200; ++step) {
    scene = world.step_by_world().scene;
    for (const Vehicle& vehicle : scene.others) {
      if (!is_object(vehicle)) continue;
      const auto [place, is_new] = before.try_emplace(vehicle.id, vehicle);
      if (!is_new) {
        EXPECT_LE(vehicle.s_m - place->second.s_m, 2.5 + 1e-6);
        way_m += vehicle.s_m - place->second.s_m;
        EXPECT_NEAR(vehicle.d_m, place->second.d_m, 1e-6);
        ++steps_seen;
      }
      place->second = vehicle;
    }
  }
  EXPECT_GT(steps_seen, 50);
  EXPECT_NEAR(way_m / steps_seen, 2.5, 0.05);  // they brake for whoever cuts in
}

TEST_F(SumoWorldTest, WritesSumosRecordOfAnEpisode) {
  const fs::path record = directory_.path() / "fcd.xml";
  SumoWorld world = make();
  world.begin({3, EgoDriver::kWorld, record});
  for (int step = 0; step < 20; ++step) world.step_by_world();
  world.end();
  std::ifstream file(record);
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_THAT(text.str(), HasSubstr("<vehicle id=\"ego\""));
  EXPECT_THAT(text.str(), HasSubstr("posLat="));
  EXPECT_THAT(text.str(), HasSubstr("<timestep time=\"19.00"));
  EXPECT_THAT(text.str(), HasSubstr("</fcd-export>"));
}

TEST_F(SumoWorldTest, SaysWhichFileIsMissing) {
  try {
    SumoWorld world(world_settings(config_), directory_.path() / "nowhere.net.xml", types(), time_);
    FAIL();
  } catch (const Failure& failure) {
    EXPECT_THAT(failure.what(), HasSubstr("nowhere.net.xml"));
  }
}

TEST_F(SumoWorldTest, SaysWhichFilesSumoRefuses) {
  std::ofstream(network()) << "<net version=\"1.9\"><edge";
  SumoWorld world = make();
  try {
    world.begin({});
    FAIL();
  } catch (const Failure& failure) {
    EXPECT_THAT(failure.what(), HasSubstr(network().string()));
  }
}

TEST_F(SumoWorldTest, IsTheOnlyOneInItsProcess) {
  const SumoWorld world = make();
  EXPECT_DEATH(make(), "one simulation a process");
}

}  // namespace
}  // namespace corridor::world
