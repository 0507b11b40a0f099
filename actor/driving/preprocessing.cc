#include "actor/driving/preprocessing.h"

namespace corridor::driving {

Window window_from(int first_corridor, double right_edge_m, double left_edge_m,
                   const DrivingSettings& settings) {
  const Lanes lanes(settings);
  Window window{first_corridor, std::vector<bool>(static_cast<std::size_t>(lanes.per_lane()))};
  for (int position = 0; position < window.size(); ++position) {
    window.open[static_cast<std::size_t>(position)] =
        lanes.fits(first_corridor + position, settings.ego.width_m, right_edge_m, left_edge_m);
  }
  return window;
}

Window keep_window(int, const Ego& ego, const DrivingSettings& settings) {
  const Lanes lanes(settings);
  const int lane = lanes.lane_at(ego.d_m);
  const double right_edge_m = lane * lanes.lane_width_m();
  return window_from(lane * lanes.per_lane(), right_edge_m, right_edge_m + lanes.lane_width_m(),
                     settings);
}

Window switch_window(int lane_change, const Ego& ego, const DrivingSettings& settings) {
  const Lanes lanes(settings);
  const int middle = lanes.corridor_at(ego.d_m) + lane_change;
  return window_from(middle - lanes.per_lane() / 2, 0.0, lanes.road_width_m(), settings);
}

}  // namespace corridor::driving
