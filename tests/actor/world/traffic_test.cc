// SPDX-License-Identifier: Apache-2.0
#include "actor/world/traffic.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace corridor::world {
namespace {

using driving::Scene;
using driving::Vehicle;
using testing::IsEmpty;
using testing::SizeIs;

TrafficScenario scenario() {
  return {{}, {}, {}, 1.0, {VehicleSize{5.0, 1.8}, VehicleSize{5.0, 1.8}, VehicleSize{10.0, 2.4}}};
}

Scene start(Traffic& traffic) {
  Scene scene{traffic.start(), {}};
  for (const Entrance& entrance : traffic.populate(scene.ego)) {
    scene.others.push_back(entrance.vehicle);
  }
  return scene;
}

// The scene as the world would show it after the change.
void apply(const TrafficChange& change, Scene& scene) {
  for (const int id : change.leaving) {
    std::erase_if(scene.others, [&](const Vehicle& vehicle) { return vehicle.id == id; });
  }
  for (const Entrance& entrance : change.entering) scene.others.push_back(entrance.vehicle);
  std::sort(scene.others.begin(), scene.others.end(),
            [](const Vehicle& a, const Vehicle& b) { return a.id < b.id; });
}

bool share_a_lane(const Vehicle& a, const Vehicle& b) { return std::abs(a.d_m - b.d_m) < 1.0; }

TEST(Traffic, BeginsWithADrawnNumberOfVehiclesWithinTheWindow) {
  std::set<std::size_t> counts;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Traffic traffic(scenario(), seed);
    Scene scene = start(traffic);
    for (const Vehicle& vehicle : scene.others) {
      EXPECT_LE(std::abs(vehicle.s_m - scene.ego.s_m), 125.0);
    }
    // Whoever found no room comes in later.
    const TrafficChange change = traffic.decide(scene);
    EXPECT_THAT(change.leaving, IsEmpty());
    counts.insert(scene.others.size() + change.entering.size());
  }
  const TrafficSettings settings = scenario().traffic;
  EXPECT_LE(*counts.rbegin(), static_cast<std::size_t>(settings.vehicles_max));
  for (int count = settings.vehicles_min; count <= settings.vehicles_max; ++count) {
    EXPECT_TRUE(counts.contains(static_cast<std::size_t>(count))) << count;
  }
}

TEST(Traffic, LeavesEveryoneRoomToBrake) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Traffic traffic(scenario(), seed);
    Scene scene = start(traffic);
    scene.others.push_back({0, scene.ego.s_m, scene.ego.d_m, scene.ego.speed_mps, 0.0, 5.0, 1.8});
    for (const Vehicle& follower : scene.others) {
      for (const Vehicle& leader : scene.others) {
        if (leader.s_m <= follower.s_m || !share_a_lane(leader, follower)) continue;
        const double gap_m = leader.s_m - leader.length_m - follower.s_m;
        const double stopping_m = follower.speed_mps + follower.speed_mps * follower.speed_mps / 9 -
                                  leader.speed_mps * leader.speed_mps / 9;
        EXPECT_GT(gap_m, 2.0);
        EXPECT_GE(gap_m, stopping_m) << "seed " << seed;
      }
    }
  }
}

TEST(Traffic, IsAFunctionOfTheSeed) {
  const auto story = [](std::uint64_t seed) {
    Traffic traffic(scenario(), seed);
    Scene scene = start(traffic);
    std::vector<Vehicle> seen = scene.others;
    for (int step = 0; step < 200; ++step) {
      scene.ego.s_m += 12.0;
      for (Vehicle& vehicle : scene.others) vehicle.s_m += vehicle.speed_mps;
      apply(traffic.decide(scene), scene);
      seen.insert(seen.end(), scene.others.begin(), scene.others.end());
    }
    return seen;
  };
  EXPECT_EQ(story(7), story(7));
  EXPECT_NE(story(7), story(8));
}

TEST(Traffic, ReplacesWhoeverLeavesAtTheOtherEnd) {
  Traffic traffic(scenario(), 1);
  Scene scene = start(traffic);
  apply(traffic.decide(scene), scene);
  for (const bool ahead : {true, false}) {
    const double side = ahead ? 1.0 : -1.0;
    const int gone = scene.others.front().id;
    const int newest = scene.others.back().id;
    scene.others.front().s_m = scene.ego.s_m + side * 125.1;
    const TrafficChange change = traffic.decide(scene);
    EXPECT_THAT(change.leaving, testing::ElementsAre(gone));
    ASSERT_THAT(change.entering, SizeIs(1));
    EXPECT_GT(change.entering[0].vehicle.id, newest);
    EXPECT_DOUBLE_EQ(change.entering[0].vehicle.s_m, scene.ego.s_m - side * 125.0);
    apply(change, scene);
  }
}

TEST(Traffic, LetsNobodyInUntilThereIsRoom) {
  Traffic traffic(scenario(), 1);
  Scene scene = start(traffic);
  apply(traffic.decide(scene), scene);
  scene.others.resize(1);
  scene.others[0].s_m = scene.ego.s_m - 126.0;  // its successor enters ahead
  for (int lane = 0; lane < 3; ++lane) {        // where standing vehicles block all lanes
    scene.others.push_back(
        {100 + lane, scene.ego.s_m + 124.0, 1.6 + 3.2 * lane, 0.0, 0.0, 5.0, 1.8});
  }
  TrafficChange change = traffic.decide(scene);
  EXPECT_THAT(change.leaving, SizeIs(1));
  EXPECT_THAT(change.entering, IsEmpty());
  apply(change, scene);
  EXPECT_THAT(traffic.decide(scene).entering, IsEmpty());
  scene.others.erase(scene.others.begin() + 1);  // the middle lane is free again
  change = traffic.decide(scene);
  ASSERT_THAT(change.entering, SizeIs(1));
  EXPECT_EQ(change.entering[0].lane, 1);
}

TEST(Traffic, EntersBehindASlowLeaderNoFasterThanIt) {
  Traffic traffic(scenario(), 1);
  Scene scene = start(traffic);
  apply(traffic.decide(scene), scene);
  scene.others.resize(1);
  scene.others[0].s_m = scene.ego.s_m + 126.0;  // its successor enters behind
  for (int lane = 0; lane < 3; ++lane) {
    scene.others.push_back(
        {100 + lane, scene.ego.s_m - 110.0, 1.6 + 3.2 * lane, 3.0, 0.0, 5.0, 1.8});
  }
  const TrafficChange change = traffic.decide(scene);
  ASSERT_THAT(change.entering, SizeIs(1));
  EXPECT_DOUBLE_EQ(change.entering[0].vehicle.speed_mps, 3.0);
}

TEST(Traffic, DrawsKindsAlignmentsAndSpeedFactorsAsSet) {
  TrafficScenario settings = scenario();
  settings.traffic.slow_share = 0.3;
  settings.traffic.truck_share = 0.1;
  settings.traffic.vehicles_min = settings.traffic.vehicles_max = 1;
  std::map<std::string, int> types;
  double sum = 0.0, squares = 0.0;
  int cars = 0;
  constexpr int kVehicles = 20'000;
  for (std::uint64_t seed = 0; seed < kVehicles; ++seed) {
    Traffic traffic(settings, seed);
    const std::vector<Entrance> entrances = traffic.populate(traffic.start());
    if (entrances.empty()) continue;
    const Entrance& entrance = entrances[0];
    ++types[entrance.type];
    if (entrance.type.starts_with("truck")) {
      EXPECT_DOUBLE_EQ(entrance.vehicle.length_m, 10.0);
      EXPECT_DOUBLE_EQ(entrance.speed_factor, 0.58);
    } else if (entrance.type.starts_with("slow")) {
      EXPECT_DOUBLE_EQ(entrance.speed_factor, 0.5);
    } else {
      EXPECT_GE(entrance.speed_factor, 0.4);
      EXPECT_LE(entrance.speed_factor, 1.15);
      sum += entrance.speed_factor;
      squares += entrance.speed_factor * entrance.speed_factor;
      ++cars;
    }
  }
  const std::map<std::string, double> shares = {{"car", 0.6}, {"slow", 0.3}, {"truck", 0.1}};
  for (const auto& [kind, share] : shares) {
    for (const char* alignment : {"center", "arbitrary", "right", "left"}) {
      const double expected = kVehicles * share / 4;
      EXPECT_NEAR(types[kind + "_" + alignment], expected, 5 * std::sqrt(expected)) << kind;
    }
  }
  const double mean = sum / cars;
  EXPECT_NEAR(mean, 0.8, 0.01);
  EXPECT_NEAR(std::sqrt(squares / cars - mean * mean), 0.146, 0.005);  // the cut takes a little
}

TrafficScenario with_objects() {
  TrafficScenario settings = scenario();
  settings.traffic.objects_per_km = 10.0;
  settings.traffic.blind_rate_per_s = 0.0;
  settings.traffic.vehicles_min = settings.traffic.vehicles_max = 0;
  return settings;
}

// The objects that have come onto the road, as they came, while the ego drove past them.
std::vector<Entrance> objects_met(Traffic& traffic, int steps, double ego_mps) {
  Scene scene = start(traffic);
  std::vector<Entrance> met;
  for (int step = 0; step < steps; ++step) {
    scene.ego.s_m += ego_mps;
    for (Vehicle& vehicle : scene.others) vehicle.s_m += vehicle.speed_mps;
    const TrafficChange change = traffic.decide(scene);
    for (const Entrance& entrance : change.entering) {
      if (entrance.type == kObjectType) met.push_back(entrance);
    }
    apply(change, scene);
  }
  return met;
}

TEST(TrafficObjects, StandAtEitherEdgeOfAnyLaneFarEnoughApart) {
  Traffic traffic(with_objects(), 5);
  const std::vector<Entrance> met = objects_met(traffic, 2000, 10.0);  // 20 km
  EXPECT_NEAR(static_cast<double>(met.size()), 200.0, 2.0);
  std::map<double, int> places;
  for (std::size_t i = 0; i < met.size(); ++i) {
    const Vehicle& object = met[i].vehicle;
    EXPECT_EQ(object.speed_mps, 0.0);
    EXPECT_EQ(object.width_m, 0.75);
    EXPECT_EQ(object.length_m, 9.0);
    if (i > 0) {
      EXPECT_GE(object.s_m - met[i - 1].vehicle.s_m, kObjectSpacing_m);
    }
    const double off_middle_m = object.d_m - (met[i].lane + 0.5) * 3.2;
    EXPECT_NEAR(std::abs(off_middle_m), 1.6 - 0.01 - 0.375, 1e-9);
    ++places[std::round(object.d_m * 100.0)];
  }
  ASSERT_THAT(places, SizeIs(6));  // three lanes, two edges
  for (const auto& [place, count] : places) EXPECT_NEAR(count, 33, 5 * std::sqrt(33.0)) << place;
}

TEST(TrafficObjects, AreAlikeForEveryoneInAnEpisode) {
  Traffic slow(with_objects(), 5), fast(with_objects(), 5), other(with_objects(), 6);
  const std::vector<Entrance> met = objects_met(slow, 1000, 7.0);
  const std::vector<Entrance> again = objects_met(fast, 500, 14.0);
  const std::vector<Entrance> others = objects_met(other, 500, 14.0);
  int equal = 0;
  for (std::size_t i = 0; i < 60; ++i) {
    EXPECT_EQ(met.at(i).vehicle.d_m, again.at(i).vehicle.d_m);
    EXPECT_NEAR(met.at(i).vehicle.s_m, again.at(i).vehicle.s_m, 14.0);
    equal += met.at(i).vehicle.d_m == others.at(i).vehicle.d_m;
  }
  EXPECT_LT(equal, 30);
}

TEST(TrafficObjects, WaitForRoomInTheirLane) {
  Traffic traffic(with_objects(), 5);
  Scene scene{traffic.start(), {}};
  for (int lane = 0; lane < 3; ++lane) {
    scene.others.push_back({lane, 0.0, 1.6 + 3.2 * lane, 10.0, 0.0, 5.0, 1.8});
  }
  const auto move_to = [&](double behind_the_end_m) {
    scene.ego.s_m += 10.0;
    for (Vehicle& vehicle : scene.others) vehicle.s_m = scene.ego.s_m + 125.0 - behind_the_end_m;
  };
  for (int step = 0; step < 50; ++step) {
    move_to(30.0);  // they could not stop
    EXPECT_THAT(traffic.decide(scene).entering, IsEmpty());
  }
  move_to(40.0);
  EXPECT_THAT(traffic.decide(scene).entering, SizeIs(1));
}

TEST(TrafficObjects, AreNoneOfTheVehiclesAndNobodyTakesTheirPlace) {
  TrafficScenario settings = with_objects();
  Traffic traffic(settings, 5);
  EXPECT_THAT(traffic.populate(traffic.start()), IsEmpty());
  Scene scene{traffic.start(), {}};
  std::size_t most = 0;
  for (int step = 0; step < 500; ++step) {
    scene.ego.s_m += 10.0;
    const TrafficChange change = traffic.decide(scene);
    for (const Entrance& entrance : change.entering) EXPECT_EQ(entrance.type, kObjectType);
    apply(change, scene);
    most = std::max(most, scene.others.size());
  }
  EXPECT_GE(most, 2u);
  EXPECT_LE(most, 4u);  // 10 a km in a window of 250 m
}

TEST(TrafficObjects, ChangeNoVehiclesDraws) {
  TrafficScenario objects = scenario();
  objects.traffic.objects_per_km = 10.0;
  Traffic with(objects, 9), without(scenario(), 9);
  EXPECT_EQ(start(with).others, start(without).others);
}

TEST(TrafficObjects, NeverGoBlind) {
  TrafficScenario settings = with_objects();
  settings.traffic.blind_rate_per_s = 1.0;
  settings.traffic.blind_range_m = 200.0;
  Traffic traffic(settings, 3);
  Scene scene{traffic.start(), {}};
  int beside = 0;
  for (int step = 0; step < 500; ++step) {
    scene.ego.s_m += 5.0;
    const TrafficChange change = traffic.decide(scene);
    EXPECT_THAT(change.going_blind, IsEmpty());
    apply(change, scene);
    beside += !scene.others.empty();
  }
  EXPECT_GT(beside, 400);
}

TEST(Traffic, LetsNobodyInThatWouldStandBehindAnObject) {
  TrafficScenario settings = with_objects();
  settings.road.lanes = 1;
  settings.traffic.vehicles_min = settings.traffic.vehicles_max = 1;
  settings.traffic.objects_per_km = 20.0;
  Traffic traffic(settings, 5);
  Scene scene = start(traffic);
  int entered = 0;
  for (int step = 0; step < 300; ++step) {
    scene.ego.s_m += 10.0;
    for (Vehicle& vehicle : scene.others) {
      if (vehicle.width_m > 1.0) vehicle.s_m += 200.0 * (vehicle.s_m > scene.ego.s_m ? 1 : -1);
    }
    const TrafficChange change = traffic.decide(scene);
    for (const Entrance& entrance : change.entering) {
      if (entrance.type == kObjectType) continue;
      EXPECT_GT(entrance.vehicle.speed_mps, 1.0);
      ++entered;
    }
    apply(change, scene);
  }
  EXPECT_GT(entered, 10);
}

// A road on which one vehicle stands still relative to the ego.
Scene with_neighbour(double ahead_m, double d_m) {
  Scene scene;
  scene.ego.s_m = 500.0;
  scene.ego.d_m = 4.8;
  scene.others = {{1, 500.0 + ahead_m, d_m, 10.0, 0.0, 5.0, 1.8}};
  return scene;
}

int blind_drivers(Traffic& traffic, const Scene& scene, int steps) {
  int count = 0;
  for (int i = 0; i < steps; ++i)
    count += static_cast<int>(traffic.decide(scene).going_blind.size());
  return count;
}

TEST(Traffic, BlindsDriversAtTheRateSet) {
  TrafficScenario settings = scenario();
  settings.traffic.blind_rate_per_s = 0.02;
  settings.traffic.blind_duration_s = 1.0;
  settings.step_s = 0.5;
  Traffic traffic(settings, 3);
  constexpr int kSteps = 50'000;
  const double expected = 0.02 * 0.5 * kSteps;
  // Who is blind already cannot go blind again: a small loss.
  EXPECT_NEAR(blind_drivers(traffic, with_neighbour(3.0, 1.6), kSteps), expected * 0.99,
              4 * std::sqrt(expected));
}

TEST(Traffic, BlindsNobodyAtRateZero) {
  TrafficScenario settings = scenario();
  settings.traffic.blind_rate_per_s = 0.0;
  Traffic traffic(settings, 3);
  EXPECT_EQ(blind_drivers(traffic, with_neighbour(3.0, 1.6), 1000), 0);
}

TEST(Traffic, BlindsOnlyNeighboursOfTheEgoNearby) {
  TrafficScenario settings = scenario();
  settings.traffic.blind_rate_per_s = 1.0;
  settings.traffic.blind_range_m = 15.0;
  Traffic traffic(settings, 3);
  EXPECT_EQ(blind_drivers(traffic, with_neighbour(15.1, 1.6), 10), 0);   // too far ahead
  EXPECT_EQ(blind_drivers(traffic, with_neighbour(-15.1, 1.6), 10), 0);  // too far behind
  EXPECT_EQ(blind_drivers(traffic, with_neighbour(10.0, 4.0), 10), 0);   // in the ego's way
  EXPECT_GT(blind_drivers(traffic, with_neighbour(14.9, 1.6), 10), 0);
  Scene at_the_right = with_neighbour(5.0, 8.0);
  at_the_right.ego.d_m = 1.6;
  EXPECT_EQ(blind_drivers(traffic, at_the_right, 10), 0);  // a lane lies between them
}

TEST(Traffic, ABlindDriverMovesTowardsTheEgoAndSeesAgainInTime) {
  TrafficScenario settings = scenario();
  settings.traffic.blind_rate_per_s = 1.0;
  settings.traffic.blind_duration_s = 4.0;
  for (const double side : {-1.0, 1.0}) {
    Traffic traffic(settings, 3);
    const Scene scene = with_neighbour(2.0, 4.8 + side * 3.2);
    TrafficChange change = traffic.decide(scene);
    ASSERT_THAT(change.going_blind, SizeIs(1));
    EXPECT_EQ(change.going_blind[0].id, 1);
    EXPECT_DOUBLE_EQ(change.going_blind[0].shift_m, -side * 3.2);
    for (int step = 1; step < 4; ++step) {
      change = traffic.decide(scene);
      EXPECT_THAT(change.seeing_again, IsEmpty());
      EXPECT_THAT(change.going_blind, IsEmpty());
    }
    EXPECT_THAT(traffic.decide(scene).seeing_again, testing::ElementsAre(1));
  }
}

TEST(Traffic, SaysNothingMoreOfABlindDriverThatHasLeft) {
  TrafficScenario settings = scenario();
  settings.traffic.blind_rate_per_s = 1.0;
  Traffic traffic(settings, 3);
  Scene scene = with_neighbour(2.0, 1.6);
  ASSERT_THAT(traffic.decide(scene).going_blind, SizeIs(1));
  scene.others[0].s_m += 200.0;
  apply(traffic.decide(scene), scene);
  for (int step = 0; step < 10; ++step) {
    const TrafficChange change = traffic.decide(scene);
    EXPECT_THAT(change.seeing_again, IsEmpty());
    apply(change, scene);
  }
}

bool equal(const TrafficSettings& a, const TrafficSettings& b) {
  return a.vehicles_min == b.vehicles_min && a.vehicles_max == b.vehicles_max &&
         a.slow_share == b.slow_share && a.speed_factor_mean == b.speed_factor_mean &&
         a.blind_rate_per_s == b.blind_rate_per_s && a.objects_per_km == b.objects_per_km;
}

TrafficDistribution wide() {
  return {.vehicles = {6, 18},
          .slow_share = {0.1, 0.4},
          .speed_factor_mean = {0.6, 0.9},
          .blind_rate_per_s = {0.0, 0.02},
          .objects_per_km = {0.0, 6.0}};
}

TEST(TrafficDistribution, OfNothingLeavesTheTrafficAsItIs) {
  EXPECT_TRUE(equal(draw_traffic({}, {}, 5), {}));
}

TEST(TrafficDistribution, DrawsOnlyWhatItSays) {
  TrafficDistribution objects;
  objects.objects_per_km = {2.0, 4.0};
  const TrafficSettings drawn = draw_traffic({}, objects, 5);
  EXPECT_GE(drawn.objects_per_km, 2.0);
  EXPECT_LE(drawn.objects_per_km, 4.0);
  TrafficSettings rest = drawn;
  rest.objects_per_km = 0.0;
  EXPECT_TRUE(equal(rest, {}));
}

TEST(TrafficDistribution, IsAFunctionOfTheEpisodeSeed) {
  EXPECT_TRUE(equal(draw_traffic({}, wide(), 7), draw_traffic({}, wide(), 7)));
  EXPECT_FALSE(equal(draw_traffic({}, wide(), 7), draw_traffic({}, wide(), 8)));
}

TEST(TrafficDistribution, IsUniformBetweenItsEndsAndOneQuantityIndependentOfAnother) {
  constexpr int kEpisodes = 10'000;
  double sum = 0.0, products = 0.0, least = 1.0, most = 0.0;
  for (std::uint64_t seed = 0; seed < kEpisodes; ++seed) {
    const TrafficSettings traffic = draw_traffic({}, wide(), seed);
    EXPECT_EQ(traffic.vehicles_min, 6);
    EXPECT_EQ(traffic.vehicles_max, 18);
    const double blind = traffic.blind_rate_per_s / 0.02;
    const double slow = (traffic.slow_share - 0.1) / 0.3;
    sum += blind;
    products += (blind - 0.5) * (slow - 0.5);
    least = std::min(least, blind);
    most = std::max(most, blind);
  }
  EXPECT_NEAR(sum / kEpisodes, 0.5, 0.015);  // five standard errors
  EXPECT_NEAR(products / kEpisodes, 0.0, 0.005);
  EXPECT_GE(least, 0.0);
  EXPECT_LT(least, 0.01);
  EXPECT_LE(most, 1.0);
  EXPECT_GT(most, 0.99);
}

}  // namespace
}  // namespace corridor::world
