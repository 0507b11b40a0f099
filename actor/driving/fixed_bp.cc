#include "actor/driving/fixed_bp.h"

namespace corridor::driving {

FixedBp::FixedBp(Command command, const DrivingSettings& settings, Skills skills)
    : command_(command), settings_(settings), skills_(skills) {}

Command FixedBp::decide(const Situation& situation) {
  return feasible(command_, situation.scene.ego, settings_, skills_);
}

}  // namespace corridor::driving
