#include "actor/driving/preprocessing.h"

namespace corridor::driving {

Command feasible(Command command, const Ego& ego, const DrivingSettings& settings) {
  const Lanes lanes(settings);
  const int lane = lanes.lane_at(ego.d_m);
  if (command == Command::kLeft && lane == lanes.lanes() - 1) return Command::kKeep;
  if (command == Command::kRight && lane == 0) return Command::kKeep;
  return command;
}

Window window_for(Command command, const Ego& ego, const DrivingSettings& settings) {
  const Lanes lanes(settings);
  const int size = lanes.per_lane();
  Window window{0, std::vector<bool>(static_cast<std::size_t>(size))};
  double right_edge_m = 0.0;
  double left_edge_m = lanes.road_width_m();
  if (command == Command::kKeep) {
    const int lane = lanes.lane_at(ego.d_m);
    window.first = lane * size;
    right_edge_m = lane * lanes.lane_width_m();
    left_edge_m = right_edge_m + lanes.lane_width_m();
  } else {
    const int towards = command == Command::kLeft ? 1 : -1;
    window.first = lanes.corridor_at(ego.d_m) + towards - window.middle();
  }
  for (int position = 0; position < size; ++position) {
    window.open[static_cast<std::size_t>(position)] =
        lanes.fits(window.first + position, settings.ego.width_m, right_edge_m, left_edge_m);
  }
  return window;
}

}  // namespace corridor::driving
