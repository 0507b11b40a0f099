// SPDX-License-Identifier: Apache-2.0
#include "actor/world/ego_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "actor/vehicle/ode_vehicle.h"
#include "actor/world/dynamic_motion.h"
#include "proto/base/failure.h"
#include "proto/base/random.h"

namespace corridor::world {
namespace {

constexpr double kRigidStep_s = 0.01;
constexpr double kSlipStep_s = 0.002;

// Box and Muller's transformation of two uniform draws.
double normal(std::uint64_t seed, std::uint64_t instant, std::uint64_t quantity) {
  const auto unit = [&](std::uint64_t draw) {
    return random_unit(seed, Purpose::kMeasurement, {instant, quantity, draw});
  };
  return std::sqrt(-2.0 * std::log1p(-unit(0))) * std::cos(2.0 * std::numbers::pi * unit(1));
}

// The ego exactly where its trajectory says, but for its body staying on the road.
class KinematicMotion : public EgoMotion {
 public:
  KinematicMotion(const DynamicsSettings& dynamics, const RoadSettings& road,
                  const EgoSettings& ego)
      : dynamics_(dynamics), road_(road), size_(ego) {}

  void begin(const driving::Ego&, std::uint64_t episode_seed) override {
    seed_ = episode_seed;
    instant_ = 0;
  }

  Motion drive(const driving::Trajectory& trajectory, double, double to_s) override {
    const driving::TrajectoryPoint point = trajectory.at(to_s);
    driving::Ego ego;
    ego.s_m = point.s_m;
    ego.d_m = on_road_m(point.d_m, road_, size_);
    ego.speed_mps = point.speed_mps;
    ego.lateral_speed_mps = point.lateral_speed_mps;
    ego.set_point_mps = trajectory.target().set_point_mps;
    return {ego, measured(ego, measurement_error(dynamics_, seed_, ++instant_), road_, size_), ego};
  }

 private:
  DynamicsSettings dynamics_;
  RoadSettings road_;
  EgoSettings size_;
  std::uint64_t seed_ = 0;
  std::uint64_t instant_ = 0;
};

vehicle::CarModel model_of(Car car) {
  switch (car) {
    case Car::kBmwX5:
      return vehicle::bmw_x5();
    case Car::kToyotaPrius:
      return vehicle::toyota_prius();
  }
  CORRIDOR_CHECK(false, "car {}", static_cast<int>(car));
}

}  // namespace

std::unique_ptr<EgoMotion> make_ego_motion(const DynamicsSettings& dynamics,
                                           const RoadSettings& road, const EgoSettings& ego) {
  const auto on_tyres = [&](const vehicle::TyreModel& tyre, double step_s) {
    const vehicle::CarModel car = model_of(dynamics.car);
    return std::make_unique<DynamicMotion>(vehicle::make_ode_vehicle(car, tyre, step_s), car, tyre,
                                           dynamics, road, ego);
  };
  switch (dynamics.world) {
    case WorldKind::kKinematic:
      return std::make_unique<KinematicMotion>(dynamics, road, ego);
    case WorldKind::kRigid:
      return on_tyres(vehicle::kRigidTyre, kRigidStep_s);
    case WorldKind::kSlip:
      return on_tyres(vehicle::slip_tyre(dynamics.friction), kSlipStep_s);
  }
  CORRIDOR_CHECK(false, "world {}", static_cast<int>(dynamics.world));
}

double on_road_m(double d_m, const RoadSettings& road, const EgoSettings& size) {
  const double margin_m = size.width_m / 2;
  return std::clamp(d_m, margin_m, road.lanes * road.lane_width_m - margin_m);
}

MeasurementError measurement_error(const DynamicsSettings& settings, std::uint64_t episode_seed,
                                   std::uint64_t instant) {
  MeasurementError error;
  if (settings.position_noise_m > 0.0) {
    error.along_m = settings.position_noise_m * normal(episode_seed, instant, 0);
    error.across_m = settings.position_noise_m * normal(episode_seed, instant, 1);
  }
  if (settings.speed_noise_mps > 0.0) {
    error.speed_mps = settings.speed_noise_mps * normal(episode_seed, instant, 2);
  }
  return error;
}

driving::Ego measured(const driving::Ego& ego, const MeasurementError& error,
                      const RoadSettings& road, const EgoSettings& size) {
  driving::Ego result = ego;
  result.s_m += error.along_m;
  result.d_m = on_road_m(ego.d_m + error.across_m, road, size);
  result.speed_mps = std::max(0.0, ego.speed_mps + error.speed_mps);
  return result;
}

}  // namespace corridor::world
