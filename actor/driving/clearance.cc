#include "actor/driving/clearance.h"

#include <algorithm>
#include <cstddef>

#include "actor/driving/prediction.h"

namespace corridor::driving {

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
