// SPDX-License-Identifier: Apache-2.0
#include "actor/world/traffic.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "proto/base/failure.h"
#include "proto/base/random.h"

namespace corridor::world {
namespace {

using driving::Vehicle;

// The ego starts so far inside the road that the window behind it lies on the road too.
constexpr double kStartMargin_m = 75.0;

// A gap in which SUMO's drivers need not brake hard: its standstill gap, a reaction time of a
// second, and what the follower takes longer to stop.
double safe_gap_m(double follower_mps, double leader_mps) {
  constexpr double kStandstillGap_m = 2.5;
  constexpr double kReaction_s = 1.0;
  constexpr double kDeceleration_mps2 = 4.5;
  const double braking_m =
      (follower_mps * follower_mps - leader_mps * leader_mps) / (2 * kDeceleration_mps2);
  return kStandstillGap_m + kReaction_s * follower_mps + std::max(0.0, braking_m);
}

// What a vehicle's random numbers are for: with its id, the counters of Purpose::kTraffic. Id 0
// is the episode itself.
enum Draw : std::uint64_t {
  kCount = 0,
  kEgoLane = 1,
  kKind = 2,
  kAlignment = 3,
  kLane = 4,
  kPlace = 1'000,         // + attempt
  kSpeedFactor = 10'000,  // + attempt
};

// What an object's random numbers are for: with its index, the counters of Purpose::kObject.
enum ObjectDraw : std::uint64_t { kObjectPlace = 0, kObjectLane = 1, kObjectSide = 2 };

// What an episode's own random number is for: with the episode seed, the counter of
// Purpose::kTrainingTraffic.
enum Quantity : std::uint64_t {
  kSlowShare = 0,
  kSpeedFactorMean = 1,
  kBlindRate = 2,
  kObjects = 3,
};

}  // namespace

Traffic::Traffic(const TrafficScenario& scenario, std::uint64_t episode_seed)
    : scenario_(scenario), seed_(episode_seed) {}

driving::Ego Traffic::start() const {
  const std::uint64_t lane = random_below(static_cast<std::uint64_t>(scenario_.road.lanes), seed_,
                                          Purpose::kTraffic, {0, kEgoLane});
  driving::Ego ego;
  ego.s_m = scenario_.traffic.window_m + kStartMargin_m;
  ego.d_m = (static_cast<double>(lane) + 0.5) * scenario_.road.lane_width_m;
  ego.speed_mps = scenario_.traffic.speed_factor_mean * scenario_.road.speed_limit_mps;
  ego.set_point_mps = ego.speed_mps;
  return ego;
}

std::vector<Entrance> Traffic::populate(const driving::Ego& ego) {
  constexpr std::uint64_t kAttempts = 30;
  const TrafficSettings& traffic = scenario_.traffic;
  const auto choices = static_cast<std::uint64_t>(traffic.vehicles_max - traffic.vehicles_min + 1);
  const int count = traffic.vehicles_min +
                    static_cast<int>(random_below(choices, seed_, Purpose::kTraffic, {0, kCount}));
  Road road = {as_vehicle(ego)};
  std::vector<Entrance> result;
  for (int i = 0; i < count; ++i) {
    // One vehicle a section of the window, so that they are spread evenly along it.
    const double section_m = 2 * traffic.window_m / count;
    const double first_s_m = ego.s_m - traffic.window_m + i * section_m;
    Candidate candidate = draw(/*ahead=*/i % 2 == 0);
    const auto id = static_cast<std::uint64_t>(candidate.entrance.vehicle.id);
    bool placed = false;
    for (std::uint64_t attempt = 0; attempt < kAttempts && !placed; ++attempt) {
      const auto lane =
          static_cast<int>(random_below(static_cast<std::uint64_t>(scenario_.road.lanes), seed_,
                                        Purpose::kTraffic, {id, kPlace + 2 * attempt}));
      const double share = random_unit(seed_, Purpose::kTraffic, {id, kPlace + 2 * attempt + 1});
      placed = place(candidate.entrance, lane, first_s_m + share * section_m, road);
    }
    if (placed) {
      result.push_back(candidate.entrance);
    } else {
      waiting_.push_back(candidate);
    }
  }
  return result;
}

TrafficChange Traffic::decide(const driving::Scene& scene) {
  ++step_;
  TrafficChange change;
  Road road = {as_vehicle(scene.ego)};
  for (const Vehicle& vehicle : scene.others) {
    const double ahead_m = vehicle.s_m - scene.ego.s_m;
    if (std::abs(ahead_m) <= scenario_.traffic.window_m) {
      road.push_back(vehicle);
      continue;
    }
    change.leaving.push_back(vehicle.id);
    if (objects_.erase(vehicle.id) > 0) continue;
    blind_until_.erase(vehicle.id);
    waiting_.push_back(draw(/*ahead=*/ahead_m < 0));
  }
  place_objects(scene.ego.s_m, road, change);
  let_in(scene.ego.s_m, road, change);
  blind(scene, change);
  return change;
}

// Vehicles that wait, in their order, each in the first lane with room from a drawn one on.
void Traffic::let_in(double ego_s_m, Road& road, TrafficChange& change) {
  const auto lanes = static_cast<std::uint64_t>(scenario_.road.lanes);
  std::erase_if(waiting_, [&](Candidate& candidate) {
    const auto id = static_cast<std::uint64_t>(candidate.entrance.vehicle.id);
    const double side = candidate.ahead ? 1.0 : -1.0;
    const double s_m = ego_s_m + side * scenario_.traffic.window_m;
    const std::uint64_t first = random_below(lanes, seed_, Purpose::kTraffic, {id, kLane, step_});
    for (std::uint64_t i = 0; i < lanes; ++i) {
      if (place(candidate.entrance, static_cast<int>((first + i) % lanes), s_m, road)) {
        change.entering.push_back(candidate.entrance);
        return true;
      }
    }
    return false;
  });
}

void Traffic::place_objects(double ego_s_m, Road& road, TrafficChange& change) {
  const TrafficSettings& traffic = scenario_.traffic;
  if (traffic.objects_per_km == 0.0) return;
  const double end_m = ego_s_m + traffic.window_m;
  if (object_place_m(next_object_) > end_m) return;
  for (const Vehicle& other : road) {
    if (objects_.contains(other.id) && end_m - other.s_m < kObjectSpacing_m) return;
  }
  Entrance entrance;
  entrance.type = kObjectType;
  entrance.speed_factor = traffic.object_speed_mps / scenario_.road.speed_limit_mps;
  entrance.vehicle.length_m = traffic.object_length_m;
  entrance.vehicle.width_m = traffic.object_width_m;
  const auto lane =
      static_cast<int>(random_below(static_cast<std::uint64_t>(scenario_.road.lanes), seed_,
                                    Purpose::kObject, {next_object_, kObjectLane}));
  if (!place(entrance, lane, end_m, road)) return;
  const bool right = random_below(2, seed_, Purpose::kObject, {next_object_, kObjectSide}) == 0;
  const double off_middle_m =
      (scenario_.road.lane_width_m + traffic.object_width_m) / 2 - traffic.object_reach_m();
  entrance.vehicle.id = next_id_++;
  entrance.vehicle.d_m += right ? -off_middle_m : off_middle_m;
  road.back() = entrance.vehicle;
  objects_.insert(entrance.vehicle.id);
  change.entering.push_back(entrance);
  ++next_object_;
}

// Where the object comes onto the road at the earliest.
double Traffic::object_place_m(std::uint64_t index) const {
  const double section_m = 1000.0 / scenario_.traffic.objects_per_km;
  const double share = random_unit(seed_, Purpose::kObject, {index, kObjectPlace});
  return start().s_m + scenario_.traffic.window_m + static_cast<double>(index) * section_m +
         share * (section_m - kObjectSpacing_m);
}

// Puts the vehicle there and onto `road`, as fast as it wants to be or as its leader is, when both
// its leader and its follower then have a safe gap.
bool Traffic::place(Entrance& entrance, int lane, double s_m, Road& road) const {
  const double lane_width_m = scenario_.road.lane_width_m;
  const double centre_m = (lane + 0.5) * lane_width_m;
  const double desired_mps = entrance.speed_factor * scenario_.road.speed_limit_mps;
  const Vehicle* leader = nullptr;
  const Vehicle* follower = nullptr;
  for (const Vehicle& other : road) {
    if (std::abs(other.d_m - centre_m) >= (other.width_m + lane_width_m) / 2) continue;
    if (other.s_m >= s_m && (!leader || other.s_m < leader->s_m)) leader = &other;
    if (other.s_m < s_m && (!follower || other.s_m > follower->s_m)) follower = &other;
  }
  double speed_mps = desired_mps;
  if (leader) {
    const double gap_m = leader->s_m - leader->length_m - s_m;
    if (gap_m < safe_gap_m(speed_mps, leader->speed_mps)) {
      if (objects_.contains(leader->id)) return false;  // nobody begins at a standstill
      speed_mps = std::min(desired_mps, leader->speed_mps);
    }
    if (gap_m < safe_gap_m(speed_mps, leader->speed_mps)) return false;
  }
  if (follower) {
    const double gap_m = s_m - entrance.vehicle.length_m - follower->s_m;
    if (gap_m < safe_gap_m(follower->speed_mps, speed_mps)) return false;
  }
  entrance.lane = lane;
  entrance.vehicle.s_m = s_m;
  entrance.vehicle.d_m = centre_m;
  entrance.vehicle.speed_mps = speed_mps;
  road.push_back(entrance.vehicle);
  return true;
}

void Traffic::blind(const driving::Scene& scene, TrafficChange& change) {
  const TrafficSettings& traffic = scenario_.traffic;
  std::erase_if(blind_until_, [&](const auto& entry) {
    if (entry.second > step_) return false;
    change.seeing_again.push_back(entry.first);
    return true;
  });
  if (random_unit(seed_, Purpose::kBlindDriver, {step_, 0}) >=
      traffic.blind_rate_per_s * scenario_.step_s) {
    return;
  }
  std::vector<BlindDriver> candidates;
  for (const Vehicle& other : scene.others) {
    const double left_m = scene.ego.d_m - other.d_m;  // the ego lies so far to its left
    const bool near =
        std::abs(other.s_m - scene.ego.s_m) <= std::min(traffic.blind_range_m, traffic.window_m);
    const bool beside = std::abs(left_m) > (other.width_m + scenario_.ego.width_m) / 2 &&
                        std::abs(left_m) < 1.5 * scenario_.road.lane_width_m;
    if (!near || !beside || blind_until_.contains(other.id) || objects_.contains(other.id))
      continue;
    candidates.push_back({other.id, std::copysign(scenario_.road.lane_width_m, left_m)});
  }
  if (candidates.empty()) return;
  const BlindDriver chosen =
      candidates[random_below(candidates.size(), seed_, Purpose::kBlindDriver, {step_, 1})];
  const auto duration =
      static_cast<std::uint64_t>(std::ceil(traffic.blind_duration_s / scenario_.step_s));
  blind_until_[chosen.id] = step_ + duration;
  change.going_blind.push_back(chosen);
}

Traffic::Candidate Traffic::draw(bool ahead) {
  const TrafficSettings& traffic = scenario_.traffic;
  Candidate candidate;
  candidate.ahead = ahead;
  Entrance& entrance = candidate.entrance;
  entrance.vehicle.id = next_id_++;
  const auto id = static_cast<std::uint64_t>(entrance.vehicle.id);
  const double share = random_unit(seed_, Purpose::kTraffic, {id, kKind});
  VehicleKind kind = VehicleKind::kCar;
  if (share < traffic.slow_share) {
    kind = VehicleKind::kSlow;
    entrance.speed_factor = traffic.slow_speed_factor;
  } else if (share < traffic.slow_share + traffic.truck_share) {
    kind = VehicleKind::kTruck;
    entrance.speed_factor = traffic.truck_speed_factor;
  } else {
    entrance.speed_factor = draw_speed_factor(id);
  }
  const VehicleSize& size = scenario_.sizes[static_cast<std::size_t>(kind)];
  entrance.vehicle.length_m = size.length_m;
  entrance.vehicle.width_m = size.width_m;
  const std::uint64_t alignment =
      random_below(kAlignments.size(), seed_, Purpose::kTraffic, {id, kAlignment});
  entrance.type = vehicle_type(kind, kAlignments[alignment]);
  return candidate;
}

// A normal distribution cut off at both ends: what falls outside is drawn again (Box and Muller).
double Traffic::draw_speed_factor(std::uint64_t id) const {
  constexpr std::uint64_t kAttempts = 100;
  const TrafficSettings& traffic = scenario_.traffic;
  for (std::uint64_t attempt = 0; attempt < kAttempts; ++attempt) {
    const std::uint64_t draw = kSpeedFactor + 2 * attempt;
    const double radius =
        std::sqrt(-2.0 * std::log(1.0 - random_unit(seed_, Purpose::kTraffic, {id, draw})));
    const double angle =
        2.0 * std::numbers::pi * random_unit(seed_, Purpose::kTraffic, {id, draw + 1});
    const double factor =
        traffic.speed_factor_mean + traffic.speed_factor_deviation * radius * std::cos(angle);
    if (factor >= traffic.speed_factor_min && factor <= traffic.speed_factor_max) return factor;
  }
  return std::clamp(traffic.speed_factor_mean, traffic.speed_factor_min, traffic.speed_factor_max);
}

Vehicle Traffic::as_vehicle(const driving::Ego& ego) const {
  return {0,
          ego.s_m,
          ego.d_m,
          ego.speed_mps,
          ego.lateral_speed_mps,
          scenario_.ego.length_m,
          scenario_.ego.width_m};
}

TrafficSettings draw_traffic(const TrafficSettings& traffic,
                             const TrafficDistribution& distribution, std::uint64_t episode_seed) {
  TrafficSettings result = traffic;
  const auto draw = [&](Quantity quantity, const std::vector<double>& range, double& value) {
    if (range.empty()) return;
    const double share = random_unit(episode_seed, Purpose::kTrainingTraffic, {quantity});
    value = range[0] + share * (range[1] - range[0]);
  };
  draw(kSlowShare, distribution.slow_share, result.slow_share);
  draw(kSpeedFactorMean, distribution.speed_factor_mean, result.speed_factor_mean);
  draw(kBlindRate, distribution.blind_rate_per_s, result.blind_rate_per_s);
  draw(kObjects, distribution.objects_per_km, result.objects_per_km);
  if (!distribution.vehicles.empty()) {  // which Traffic draws from once an episode
    result.vehicles_min = distribution.vehicles[0];
    result.vehicles_max = distribution.vehicles[1];
  }
  return result;
}

}  // namespace corridor::world
