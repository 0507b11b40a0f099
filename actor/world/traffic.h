// SPDX-License-Identifier: Apache-2.0
// The traffic around the ego, decided: who is there at the start, who leaves and who enters, and
// who drives blindly. Pure: a function of the settings, the episode's seed and the scenes shown;
// the world carries the decisions out.
//
// A treadmill: a drawn number of vehicles is kept up within window_m of the ego, ahead and behind.
// One that leaves the window is removed, and another, of random kind, enters at the other end as
// soon as one of the lanes has room there. The road far from the ego is empty.
//
// Objects stand, or crawl, at an edge of a lane. They are no part of that number: the road is cut
// into sections of equal length, each has one object, in a drawn place, and it comes onto the road
// as soon as the window ahead has reached that place and there is room. Two objects are at least
// kObjectSpacing_m apart when they come, so that they never block two lanes side by side.
//
// Blind drivers: at blind_rate_per_s in all, a vehicle within blind_range_m along the road and
// beside the ego's lane moves over by one lane width towards the ego without looking, and for
// blind_duration_s looks at nobody beside it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "actor/driving/scene.h"
#include "proto/settings/settings.h"
#include "proto/settings/sumo_names.h"

namespace corridor::world {

struct VehicleSize {
  double length_m = 0.0;
  double width_m = 0.0;
};

// What Traffic needs to know of the scenario.
struct TrafficScenario {
  TrafficSettings traffic;
  RoadSettings road;
  EgoSettings ego;
  double step_s = 1.0;
  std::array<VehicleSize, kVehicleKinds.size()> sizes;  // by VehicleKind
};

inline constexpr double kObjectSpacing_m = 40.0;

// A vehicle that is put on the road: in the middle of a lane, an object at its edge.
struct Entrance {
  driving::Vehicle vehicle;
  int lane = 0;
  std::string type;           // SUMO's vehicle type
  double speed_factor = 1.0;  // desired speed / speed limit
};

struct BlindDriver {
  int id = 0;
  double shift_m = 0.0;  // > 0 to the left
};

struct TrafficChange {
  std::vector<int> leaving;  // ids
  std::vector<Entrance> entering;
  std::vector<BlindDriver> going_blind;
  std::vector<int> seeing_again;  // ids; never of vehicles that have left
};

class Traffic {
 public:
  Traffic(const TrafficScenario& scenario, std::uint64_t episode_seed);

  // Where the ego starts: the same s always, a drawn lane, the speed of a car of mean haste.
  driving::Ego start() const;
  // Called once, for the scene's first vehicles.
  std::vector<Entrance> populate(const driving::Ego& ego);
  // Called after every step with all that is on the road.
  TrafficChange decide(const driving::Scene& scene);

 private:
  // A vehicle that is to be on the road and waits for room.
  struct Candidate {
    Entrance entrance;   // without place and speed
    bool ahead = false;  // at which end of the window it enters
  };
  using Road = std::vector<driving::Vehicle>;

  Candidate draw(bool ahead);
  double draw_speed_factor(std::uint64_t id) const;
  bool place(Entrance& entrance, int lane, double s_m, Road& road) const;
  void let_in(double ego_s_m, Road& road, TrafficChange& change);
  void place_objects(double ego_s_m, Road& road, TrafficChange& change);
  double object_place_m(std::uint64_t index) const;
  void blind(const driving::Scene& scene, TrafficChange& change);
  driving::Vehicle as_vehicle(const driving::Ego& ego) const;

  TrafficScenario scenario_;
  std::uint64_t seed_;
  std::uint64_t step_ = 0;
  int next_id_ = 1;
  std::vector<Candidate> waiting_;
  std::uint64_t next_object_ = 0;
  std::set<int> objects_;                     // ids of those on the road
  std::map<int, std::uint64_t> blind_until_;  // id -> step at which it sees again
};

// The traffic of one training episode: `traffic`, with the episode's own values for what
// `distribution` says, so that planners learn to drive in more than one kind (domain randomisation,
// Tobin et al. 2017). What SUMO's vehicle types hold (sizes, keep_right) is the run's and the same
// for all.
TrafficSettings draw_traffic(const TrafficSettings& traffic,
                             const TrafficDistribution& distribution, std::uint64_t episode_seed);

}  // namespace corridor::world
