#include "actor/driving/prediction.h"

#include <algorithm>
#include <cmath>

#include "actor/driving/trajectory.h"

namespace corridor::driving {

Ego after_step(const Ego& ego, const Target& target, const DrivingSettings& settings) {
  const TrajectoryPoint end = Trajectory(ego, target, settings).at(settings.step_s);
  return {end.s_m,
          end.d_m,
          end.speed_mps,
          end.acceleration_mps2,
          end.lateral_speed_mps,
          target.set_point_mps};
}

Ego after_step(const Ego& ego, const MopAction& action, const DrivingSettings& settings) {
  return after_step(ego, target_for(action, ego, settings), settings);
}

double way_m(double speed_mps, double braking_mps2, double time_s) {
  return speed_mps >= braking_mps2 * time_s ? (speed_mps - braking_mps2 * time_s / 2) * time_s
                                            : speed_mps * speed_mps / (2 * braking_mps2);
}

double separation_m(const Ego& ego, const Vehicle& other, const EgoSettings& size) {
  const double along_m = std::max(other.s_m - other.length_m - ego.s_m,  // it is ahead
                                  ego.s_m - size.length_m - other.s_m);  // or behind
  const double across_m = std::abs(ego.d_m - other.d_m) - (size.width_m + other.width_m) / 2;
  return std::max(along_m, across_m);
}

}  // namespace corridor::driving
