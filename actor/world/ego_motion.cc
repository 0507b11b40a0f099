#include "actor/world/ego_motion.h"

#include <algorithm>

#include "actor/vehicle/ode_vehicle.h"
#include "actor/world/dynamic_motion.h"
#include "actor/world/kinematic_motion.h"
#include "proto/base/failure.h"

namespace corridor::world {
namespace {

constexpr double kRigidStep_s = 0.01;
constexpr double kSlipStep_s = 0.002;

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
    return std::make_unique<DynamicMotion>(std::make_unique<vehicle::OdeVehicle>(car, tyre, step_s),
                                           car, tyre, dynamics, road, ego);
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

}  // namespace corridor::world
