#include "proto/settings/named_networks.h"

#include "proto/settings/settings.h"

namespace corridor {

PlannerShape mop_shape(const RunConfig& config) {
  return mop_shape(config.planner.corridors_per_lane,
                   static_cast<int>(config.planner.speed_changes_mps.size()),
                   config.planner.clearance_steps);
}

PlannerShape bp_shape(const RunConfig& config) { return bp_shape(config.road.lanes); }

}  // namespace corridor
