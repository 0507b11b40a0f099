#include "actor/world/kinematic_motion.h"

#include "actor/world/measurement.h"

namespace corridor::world {

KinematicMotion::KinematicMotion(const DynamicsSettings& dynamics, const RoadSettings& road,
                                 const EgoSettings& ego)
    : dynamics_(dynamics), road_(road), size_(ego) {}

void KinematicMotion::begin(const driving::Ego&, std::uint64_t episode_seed) {
  seed_ = episode_seed;
  instant_ = 0;
}

Motion KinematicMotion::drive(const driving::Trajectory& trajectory, double, double to_s) {
  const driving::TrajectoryPoint point = trajectory.at(to_s);
  driving::Ego ego;
  ego.s_m = point.s_m;
  ego.d_m = on_road_m(point.d_m, road_, size_);
  ego.speed_mps = point.speed_mps;
  ego.lateral_speed_mps = point.lateral_speed_mps;
  ego.set_point_mps = trajectory.target().set_point_mps;
  return {ego, measured(ego, measurement_error(dynamics_, seed_, ++instant_), road_, size_), ego};
}

}  // namespace corridor::world
