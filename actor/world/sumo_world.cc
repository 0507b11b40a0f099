// SPDX-License-Identifier: Apache-2.0
#include "actor/world/sumo_world.h"

#include <libsumo/libsumo.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <utility>
#include <xercesc/util/PlatformUtils.hpp>

#include "proto/base/failure.h"
#include "proto/base/random.h"
#include "proto/settings/collision_kinds.h"
#include "proto/settings/sumo_names.h"
#include "proto/system/files.h"

namespace corridor::world {
namespace {

using driving::Ego;
using driving::Scene;
using driving::Vehicle;
using Sumo = libsumo::Simulation;
using SumoVehicle = libsumo::Vehicle;

constexpr const char* kEgo = "ego";  // its id
// An intrusion into the next lane that is less is none.
constexpr double kIntrusion_m = 0.1;

// SUMO's modes (its TraCI documentation, "Change Vehicle State").
constexpr int kNoSpeedChecks = 0;
constexpr int kNoLaneChanges = 0;          // of its own, and requested ones without a look
constexpr int kDefaultLaneChanges = 1621;  // its own, requests with a look
constexpr int kKeepExactPosition = 2;      // moveToXY's keepRoute

std::atomic<bool> world_exists = false;

std::string sumo_id(int id) { return fmt::format("v{}", id); }

// The folder of a file that is there.
std::filesystem::path folder_of(const std::filesystem::path& file) {
  if (std::filesystem::is_regular_file(file)) return parent_of(file);
  throw Failure("no file {} for SUMO: the run directory is incomplete", file.string());
}

// SUMO does not look whether what it writes gets to the disk.
void check_complete(const std::filesystem::path& fcd_output) {
  constexpr const char* kEnd = "</fcd-export>";
  constexpr std::uintmax_t kLastBytes = 100;
  std::error_code missing;
  const auto size = std::filesystem::file_size(fcd_output, missing);
  std::ifstream file(fcd_output, std::ios::binary);
  if (!missing && size > kLastBytes) file.seekg(static_cast<std::streamoff>(size - kLastBytes));
  const std::string last{std::istreambuf_iterator<char>(file), {}};
  if (last.find(kEnd) != std::string::npos) return;
  throw Failure("SUMO could not write all of {}: is the disk full?", fcd_output.string());
}

void obey_trajectories(const std::string& id) {
  SumoVehicle::setSpeedMode(id, kNoSpeedChecks);
  SumoVehicle::setLaneChangeMode(id, kNoLaneChanges);
}

// Calls into SUMO; what it throws becomes a Failure (its details are on standard error).
template <typename Function>
auto in_sumo(const std::string& doing, Function&& function) {
  try {
    return function();
  } catch (const std::exception& error) {
    throw Failure("SUMO failed while {}: {}", doing, error.what());
  }
}

}  // namespace

SumoWorld::SumoWorld(const WorldSettings& settings, std::filesystem::path network,
                     std::filesystem::path vehicle_types, TimeAccount& time)
    : settings_(settings),
      network_(std::move(network)),
      vehicle_types_(std::move(vehicle_types)),
      network_folder_(folder_of(network_)),
      vehicle_types_folder_(folder_of(vehicle_types_)),
      time_(time),
      motion_(make_ego_motion(settings.dynamics, settings.road, settings.ego)) {
  CORRIDOR_CHECK(!world_exists.exchange(true), "libsumo holds one simulation a process");
  // SUMO starts its XML parser for each load and ends it again, which is half of a load's cost.
  // Starts are counted: with one more the parser stays.
  xercesc::XMLPlatformUtils::Initialize();
}

SumoWorld::~SumoWorld() {
  if (running_) Sumo::close();
  xercesc::XMLPlatformUtils::Terminate();
  world_exists = false;
}

driving::Scene SumoWorld::begin(const EpisodeStart& start) {
  time_.charge(TimePart::kPlan);
  end();
  fcd_output_ = start.fcd_output;
  if (!fcd_output_.empty()) fcd_folder_.emplace(parent_of(fcd_output_));
  in_sumo(fmt::format("loading {} and {}", network_.string(), vehicle_types_.string()),
          [&] { Sumo::load(options(start)); });
  running_ = true;
  return in_sumo("starting an episode", [&] {
    driver_ = start.driver;
    seed_ = start.seed;
    watch_ = start.watch;
    ghost_lane_.reset();
    ghosts_ = 0;
    const auto right_lane = libsumo::Lane::getShape(sumo_lane(0)).value;
    right_edge_y_m_ = right_lane.front().y - settings_.road.lane_width_m / 2;
    new_objects_.clear();
    traffic_.emplace(traffic_scenario(start), start.seed);
    scene_ = Scene{traffic_->start(), {}};
    add_ego(scene_.ego, start.driver);
    motion_->begin(scene_.ego, seed_);
    for (const Entrance& entrance : traffic_->populate(scene_.ego)) add(entrance);
    time_.charge(TimePart::kLoad);
    return scene_;
  });
}

StepResult SumoWorld::step(const driving::Trajectory& trajectory) {
  CORRIDOR_CHECK(running_ && driver_ == EgoDriver::kPlanner);
  time_.charge(TimePart::kPlan);
  return in_sumo("placing the ego and stepping", [&] {
    const double before_mps = scene_.ego.speed_mps;
    StepResult result;
    for (int i = 0; i < settings_.simulation.substeps && !result.collision; ++i) {
      const double from_s = i * settings_.simulation.substep_s();
      const double to_s = (i + 1) * settings_.simulation.substep_s();
      Motion motion = motion_->drive(trajectory, from_s, to_s);
      motion.ego.acceleration_mps2 = (motion.ego.speed_mps - before_mps) / to_s;
      motion.measured.acceleration_mps2 = motion.ego.acceleration_mps2;
      place(motion.ego);
      // SUMO moves the others first, past the ego where it was, and then places the ego: after the
      // step all are at the same instant.
      simulate();
      result = finish_substep(motion);
    }
    return result;
  });
}

StepResult SumoWorld::step_by_world() {
  CORRIDOR_CHECK(running_ && driver_ == EgoDriver::kWorld);
  time_.charge(TimePart::kPlan);
  return in_sumo("stepping", [&] {
    const Ego before = scene_.ego;
    StepResult result;
    for (int i = 0; i < settings_.simulation.substeps && !result.collision; ++i) {
      simulate();
      const libsumo::TraCIPosition position = SumoVehicle::getPosition(kEgo);
      const double so_far_s = (i + 1) * settings_.simulation.substep_s();
      Ego ego;
      ego.s_m = position.x;
      ego.d_m = position.y - right_edge_y_m_;
      ego.speed_mps = SumoVehicle::getSpeed(kEgo);
      ego.acceleration_mps2 = (ego.speed_mps - before.speed_mps) / so_far_s;
      ego.lateral_speed_mps = (ego.d_m - before.d_m) / so_far_s;
      result = finish_substep({ego, ego, ego});
    }
    return result;
  });
}

driving::Scene SumoWorld::take_over() {
  CORRIDOR_CHECK(running_ && driver_ == EgoDriver::kWorld);
  return in_sumo("taking over the ego", [&] {
    driver_ = EgoDriver::kPlanner;
    obey_trajectories(kEgo);
    Ego& ego = scene_.ego;
    ego.set_point_mps = std::min(ego.speed_mps, settings_.road.speed_limit_mps);
    motion_->begin(ego, seed_);
    return scene_;
  });
}

void SumoWorld::place(const Ego& ego) {
  constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;
  // SUMO counts from north, clockwise; without an angle the ego stands along its lane.
  const double angle =
      ego.yaw_rad == 0.0 ? libsumo::INVALID_DOUBLE_VALUE : 90.0 - kDegreesPerRadian * ego.yaw_rad;
  const double d_m = on_road_m(ego.d_m, settings_.road, settings_.ego);
  SumoVehicle::moveToXY(kEgo, kSumoRoad, -1, ego.s_m, right_edge_y_m_ + d_m, angle,
                        kKeepExactPosition);
  SumoVehicle::setSpeed(kEgo, ego.speed_mps);
  if (settings_.dynamics.ghost) place_ghost(ego);
}

// SUMO's drivers see the ego in the lane that its middle is in. Where its body reaches into another
// one, they meet a vehicle as long and fast as it, just across the line.
void SumoWorld::place_ghost(const Ego& ego) {
  const double lane_m = settings_.road.lane_width_m;
  const int lane = std::clamp(static_cast<int>(ego.d_m / lane_m), 0, settings_.road.lanes - 1);
  const double from_line_m = ego.d_m - lane * lane_m;
  const double reach_m = settings_.ego.width_m / 2 - kIntrusion_m;
  std::optional<int> intruded;
  if (from_line_m < reach_m && lane > 0) intruded = lane - 1;
  if (lane_m - from_line_m < reach_m && lane + 1 < settings_.road.lanes) intruded = lane + 1;

  if (ghost_lane_ && ghost_lane_ != intruded) {
    SumoVehicle::remove(fmt::format("{}{}", kGhostType, ghosts_));
    ghost_lane_.reset();
  }
  if (!intruded) return;
  if (!ghost_lane_) {
    const std::string id = fmt::format("{}{}", kGhostType, ++ghosts_);
    SumoVehicle::add(id, kSumoRoad, kGhostType);
    SumoVehicle::moveTo(id, sumo_lane(*intruded), scene_.ego.s_m);
    SumoVehicle::setPreviousSpeed(id, ego.speed_mps);
    obey_trajectories(id);
    ghost_lane_ = intruded;
  }
  const std::string id = fmt::format("{}{}", kGhostType, ghosts_);
  const double width_m = SumoVehicle::getWidth(id);
  const double d_m =
      *intruded < lane ? lane * lane_m - width_m / 2 : (lane + 1) * lane_m + width_m / 2;
  SumoVehicle::moveToXY(id, kSumoRoad, -1, ego.s_m, right_edge_y_m_ + d_m,
                        libsumo::INVALID_DOUBLE_VALUE, kKeepExactPosition);
  SumoVehicle::setSpeed(id, ego.speed_mps);
}

void SumoWorld::simulate() {
  time_.charge(TimePart::kWorld);
  put_objects_to_the_edge();
  Sumo::step();
  time_.charge(TimePart::kSimulate);
}

void SumoWorld::end() {
  if (!std::exchange(running_, false)) return;
  in_sumo("ending an episode", [] { Sumo::close(); });
  if (!fcd_output_.empty()) check_complete(std::exchange(fcd_output_, {}));
}

// moveToXY, which alone knows of a place across the lane, is carried out at the end of the next
// step. One that no step follows would stay pending in libsumo, and hit a vehicle of the same id,
// or freed memory, in the next episode: hence just before the step.
void SumoWorld::put_objects_to_the_edge() {
  for (const Vehicle& object : new_objects_) {
    const double s_m = object.s_m + object.speed_mps * settings_.simulation.substep_s();
    SumoVehicle::moveToXY(sumo_id(object.id), kSumoRoad, -1, s_m, right_edge_y_m_ + object.d_m,
                          libsumo::INVALID_DOUBLE_VALUE, kKeepExactPosition);
  }
  new_objects_.clear();
}

StepResult SumoWorld::finish_substep(const Motion& after) {
  const Scene before = scene_;
  scene_.ego = after.ego;
  read_others();
  StepResult result;
  result.collision = driving::find_collision(before, scene_, settings_.ego);
  const double road_width_m = settings_.road.lanes * settings_.road.lane_width_m;
  if (scene_.ego.d_m < 0.0 || scene_.ego.d_m > road_width_m) {
    result.collision = driving::Collision{CollisionKind::kOffRoad, 0};
  }
  const TrafficChange change = traffic_->decide(scene_);
  time_.charge(TimePart::kWorld);
  apply(change);
  time_.charge(TimePart::kTraffic);
  if (watch_) watch_(scene_);
  result.scene = scene_;
  result.measured = after.measured;
  result.reference = after.reference;
  time_.charge(TimePart::kWorld);
  return result;
}

// SUMO's lateral speed is exactly the last step's displacement over its duration.
void SumoWorld::read_others() {
  for (Vehicle& vehicle : scene_.others) {
    const std::string id = sumo_id(vehicle.id);
    const libsumo::TraCIPosition position = SumoVehicle::getPosition(id);
    vehicle.s_m = position.x;
    vehicle.d_m = position.y - right_edge_y_m_;
    vehicle.speed_mps = SumoVehicle::getSpeed(id);
    vehicle.lateral_speed_mps = SumoVehicle::getLateralSpeed(id);
  }
}

void SumoWorld::apply(const TrafficChange& change) {
  for (const int id : change.leaving) {
    SumoVehicle::remove(sumo_id(id));
    std::erase_if(scene_.others, [&](const Vehicle& vehicle) { return vehicle.id == id; });
  }
  for (const Entrance& entrance : change.entering) add(entrance);
  for (const int id : change.seeing_again) {
    SumoVehicle::setLaneChangeMode(sumo_id(id), kDefaultLaneChanges);
  }
  for (const BlindDriver& driver : change.going_blind) {
    SumoVehicle::setLaneChangeMode(sumo_id(driver.id), kNoLaneChanges);
    SumoVehicle::changeSublane(sumo_id(driver.id), driver.shift_m);
  }
}

// `add` alone leaves a vehicle waiting for SUMO's own insertion; moveTo puts it on the road at
// once.
void SumoWorld::add(const Entrance& entrance) {
  const std::string id = sumo_id(entrance.vehicle.id);
  SumoVehicle::add(id, kSumoRoad, entrance.type);
  SumoVehicle::setSpeedFactor(id, entrance.speed_factor);
  SumoVehicle::moveTo(id, sumo_lane(entrance.lane), entrance.vehicle.s_m);
  SumoVehicle::setPreviousSpeed(id, entrance.vehicle.speed_mps);
  if (entrance.type == kObjectType) {
    SumoVehicle::setLaneChangeMode(id, kNoLaneChanges);
    new_objects_.push_back(entrance.vehicle);
  }
  const auto place = std::ranges::lower_bound(scene_.others, entrance.vehicle.id, {}, &Vehicle::id);
  scene_.others.insert(place, entrance.vehicle);
}

void SumoWorld::add_ego(const driving::Ego& ego, EgoDriver driver) {
  const int lane = static_cast<int>(ego.d_m / settings_.road.lane_width_m);
  SumoVehicle::add(kEgo, kSumoRoad, kEgoType);
  SumoVehicle::moveTo(kEgo, sumo_lane(lane), ego.s_m);
  SumoVehicle::setPreviousSpeed(kEgo, ego.speed_mps);
  if (driver == EgoDriver::kPlanner) obey_trajectories(kEgo);
}

std::vector<std::string> SumoWorld::options(const EpisodeStart& start) const {
  const std::uint64_t seed = random_bits(start.seed, Purpose::kSumo, {}) >> 33;
  std::vector<std::string> result = {
      "--net-file", network_folder_.path() / network_.filename(), "--route-files",
      vehicle_types_folder_.path() / vehicle_types_.filename(), "--seed", fmt::format("{}", seed),
      "--step-length", fmt::format("{}", settings_.simulation.substep_s()), "--lateral-resolution",
      fmt::format("{}", settings_.simulation.lateral_resolution_m), "--time-to-teleport", "-1",
      // Collisions are ours to find (actor/driving/collision.h).
      "--collision.action", "none", "--collision.mingap-factor", "0", "--no-step-log",
      "--no-warnings", "--duration-log.disable", "--xml-validation", "never"};
  if (!start.fcd_output.empty()) {
    result.insert(
        result.end(),
        {"--fcd-output", fcd_folder_->path() / fcd_output_.filename(), "--fcd-output.attributes",
         "x,y,angle,type,speed,acceleration,pos,lane,posLat", "--precision", "4"});
  }
  return result;
}

// The sizes of the vehicle types, as the file that SUMO has loaded gives them.
TrafficScenario SumoWorld::traffic_scenario(const EpisodeStart& start) const {
  const auto size = [](VehicleKind kind) {
    const std::string type = vehicle_type(kind, kAlignments.front());
    return VehicleSize{libsumo::VehicleType::getLength(type), libsumo::VehicleType::getWidth(type)};
  };
  return {start.traffic.value_or(settings_.traffic),
          settings_.road,
          settings_.ego,
          settings_.simulation.substep_s(),
          {size(VehicleKind::kCar), size(VehicleKind::kSlow), size(VehicleKind::kTruck)}};
}

}  // namespace corridor::world
