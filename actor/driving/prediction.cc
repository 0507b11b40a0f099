// SPDX-License-Identifier: Apache-2.0
#include "actor/driving/prediction.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

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

void predicted_clearances_m(const Scene& scene, const DrivingSettings& settings,
                            std::span<double> out) {
  const int speed_changes[] = {0, unchanged_speed(settings)};
  std::size_t next = 0;
  for (int corridor_change = -1; corridor_change <= 1; ++corridor_change) {
    for (const int speed_change : speed_changes) {
      Ego ego = scene.ego;
      for (int step = 1; step <= settings.planner.clearance_steps; ++step) {
        ego = after_step(ego, MopAction{corridor_change, speed_change}, settings);
        const double time_s = step * settings.step_s;
        double nearest_m = kClearanceMax_m;
        for (Vehicle other : scene.others) {
          other.s_m += other.speed_mps * time_s;
          other.d_m += other.lateral_speed_mps * time_s;
          nearest_m = std::min(nearest_m, separation_m(ego, other, settings.ego));
        }
        out[next++] = nearest_m;
      }
    }
  }
}

}  // namespace corridor::driving
