// SPDX-License-Identifier: Apache-2.0
// The safety shield (Alshiekh et al. 2018, "Safe Reinforcement Learning via Shielding"): an action
// after which the ego could no longer get out of the others' way gives way to the nearest one after
// which it still can.
#pragma once

#include <memory>

#include "actor/driving/planner.h"
#include "proto/settings/settings.h"

namespace corridor::driving {

// What the shield reckons with. An action is safe when a manoeuvre of kShieldHorizon_s that begins
// with it, and then repeats one corridor change and one speed change, keeps kShieldMargin_m from
// everybody (separation_m) at and between the ends of its steps. It must be so twice over: when the
// others go on at their speed, sideways up to the lane that they are moving to; and when, at the
// worst, those ahead brake by kShieldLeaderBraking_mps2. Whoever cuts in so close to the next one
// that SUMO stops it at once is expected to stop at once; those behind, beside the ego's way, to
// brake comfortably after a second; who follows in the ego's way is left to look after itself.
inline constexpr double kShieldHorizon_s = 4.0;
inline constexpr double kShieldMargin_m = 0.2;
inline constexpr double kShieldLeaderBraking_mps2 = 2.0;

// The action itself where it is safe. Otherwise the one that keeps furthest away, up to the margin,
// when all goes as expected, and then at the worst; among equals the one nearest to it: rather
// another speed than another corridor.
MopAction shielded(const MopAction& action, const Scene& scene, const DrivingSettings& settings);

// Another motion planner behind the shield.
class ShieldedMop : public MotionPlanner {
 public:
  ShieldedMop(std::unique_ptr<MotionPlanner> planner, const DrivingSettings& settings);
  int decide(const Situation& situation, const Window& window) override;

 private:
  std::unique_ptr<MotionPlanner> planner_;
  DrivingSettings settings_;
};

}  // namespace corridor::driving
