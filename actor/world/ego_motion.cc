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

}  // namespace

std::unique_ptr<EgoMotion> make_ego_motion(const DynamicsSettings& dynamics,
                                           const RoadSettings& road, const EgoSettings& ego) {
  if (dynamics.world == WorldKind::kKinematic) {
    return std::make_unique<KinematicMotion>(dynamics, road, ego);
  }
  const bool slips = dynamics.world == WorldKind::kSlip;
  const vehicle::CarModel car =
      dynamics.car == Car::kBmwX5 ? vehicle::bmw_x5() : vehicle::toyota_prius();
  const vehicle::TyreModel tyre =
      slips ? vehicle::slip_tyre(dynamics.friction) : vehicle::kRigidTyre;
  return std::make_unique<DynamicMotion>(
      std::make_unique<vehicle::OdeVehicle>(car, tyre, slips ? kSlipStep_s : kRigidStep_s), car,
      tyre, dynamics, road, ego);
}

double on_road_m(double d_m, const RoadSettings& road, const EgoSettings& size) {
  const double margin_m = size.width_m / 2;
  return std::clamp(d_m, margin_m, road.lanes * road.lane_width_m - margin_m);
}

}  // namespace corridor::world
