// SPDX-License-Identifier: Apache-2.0
// The keys of proto/settings/driving_settings.h, as proto/config/config_keys.h describes them.
// Private to proto/.
#pragma once

#include "proto/config/config_key.h"
#include "proto/settings/driving_settings.h"
#include "proto/settings/transition.h"

namespace corridor::config_keys {

// With three corridor changes and kSkillCount commands each, an action still fits a byte
// (actor/driving/action.h).
inline constexpr std::size_t kSpeedChangesMax = 256 / (3 * kSkillCount);

template <typename Visitor>
void describe(RoadSettings& road, Visitor& v) {
  v.table("road", "One straight edge. Lanes count from the right, 0 first.", Heeds::kWorld);
  v.key({"lanes"}, road.lanes, 1, 8);
  v.key({"lane_width_m", "a multiple of simulation.lateral_resolution_m"}, road.lane_width_m, 2.0,
        6.0);
  v.key({"length_m", "an episode at the speed limit must fit"}, road.length_m, 100.0, 1e6);
  v.key({"speed_limit_mps"}, road.speed_limit_mps, 1.0, 70.0);
}

template <typename Visitor>
void describe(EgoSettings& ego, Visitor& v) {
  v.table("ego", "The car that is driven, and its kinematic limits.", Heeds::kWorld);
  v.key({"length_m"}, ego.length_m, 1.0, 20.0);
  v.key({"width_m"}, ego.width_m, 0.5, 3.0);
  v.key({"acceleration_max_mps2"}, ego.acceleration_max_mps2, 0.1, 20.0);
  v.key({"deceleration_max_mps2"}, ego.deceleration_max_mps2, 0.1, 20.0);
}

template <typename Visitor>
void describe(PlannerSettings& planner, Visitor& v) {
  v.table("planner", "The state-action abstraction of paper section III-C.", Heeds::kTraining);
  v.key({"corridors_per_lane", "N_c: odd, so that there is a middle"}, planner.corridors_per_lane,
        3, 15);
  v.key({"speed_changes_mps", "of the set-point, ascending"}, planner.speed_changes_mps,
        ListSize{1, kSpeedChangesMax}, -20.0, 20.0);
  v.key({"corridor_change_s", "time to move over by one corridor", Heeds::kWorld},
        planner.corridor_change_s, 0.1, 10.0);
  v.key({"gap_range_m"}, planner.gap_range_m, 10.0, 500.0);
  v.key({"side_clearance_m", "added to each side of the ego in a corridor's swath"},
        planner.side_clearance_m, 0.0, 1.0);
  v.key({"look_ahead_s", "others occupy what their lateral speed reaches by then"},
        planner.look_ahead_s, 0.0, 10.0);
  v.key({"clearance_steps", "how far the MoP sees what its moves lead to; 0: not at all"},
        planner.clearance_steps, 0, 10);
}

template <typename Visitor>
void describe(MopRewardSettings& reward, Visitor& v) {
  v.table("mop_reward", "Paper section III-C; d = headway_s * v + standstill_gap_m.",
          Heeds::kTraining);
  v.key({"speed_tolerance_mps"}, reward.speed_tolerance_mps, 0.0, 20.0);
  v.key({"headway_s", "tau"}, reward.headway_s, 0.0, 10.0);
  v.key({"standstill_gap_m", "d0"}, reward.standstill_gap_m, 0.0, 50.0);
  v.key({"near_low", "the smallest front gap is near d from this * d"}, reward.near_low, 0.0, 10.0);
  v.key({"near_high", "to this * d + near_high_offset_m"}, reward.near_high, 0.0, 10.0);
  v.key({"near_high_offset_m"}, reward.near_high_offset_m, 0.0, 100.0);
  v.key({"acceleration_penalty", "for each m/s2"}, reward.acceleration_penalty, 0.0, 1.0);
}

template <typename Visitor>
void describe(BpRewardSettings& reward, Visitor& v) {
  v.table("bp_reward", "Paper section III-B.", Heeds::kWorld);
  v.key({"thresholds_mps", "one a lane, from the right"}, reward.thresholds_mps, ListSize{1, 8},
        0.0, 70.0);
  v.key({"left_change"}, reward.left_change, -1000.0, 1000.0);
  v.key({"collision_shaping", "in training only; not the paper's, not reported"},
        reward.collision_shaping, -1000.0, 0.0);
  v.key({"lane_change_shaping", "likewise, on a change to either side"}, reward.lane_change_shaping,
        -1000.0, 0.0);
}

template <typename Visitor>
void describe(RulesSettings& rules, Visitor& v) {
  v.table("rules", "The rule-based planners.", Heeds::kTraining);
  v.key({"slow_leader_mps", "leave a lane whose leader is this much below the target"},
        rules.slow_leader_mps, 0.0, 70.0);
  v.key({"leader_range_m", "leaders further away do not matter"}, rules.leader_range_m, 0.0, 500.0);
  v.key({"gain_mps", "a lane must promise this much more to change to it"}, rules.gain_mps, 0.0,
        70.0);
  v.key({"front_gap_s", "the least gap to change into, ahead, at ego speed"}, rules.front_gap_s,
        0.0, 10.0);
  v.key({"back_gap_s", "and behind, at the follower's speed"}, rules.back_gap_s, 0.0, 10.0);
  v.key({"gap_min_m"}, rules.gap_min_m, 0.0, 100.0);
  v.key({"return_right_s", "go back right when nothing is nearer ahead than this"},
        rules.return_right_s, 0.0, 60.0);
}

template <typename Visitor>
void describe(RandomBpSettings& bp, Visitor& v) {
  v.table("random_bp", "The behaviour planner that asks while the MoP is trained (III-D).",
          Heeds::kTraining);
  v.key({"hold_steps_min", "between two lane changes"}, bp.hold_steps_min, 1, 100'000);
  v.key({"hold_steps_max"}, bp.hold_steps_max, 1, 100'000);
  v.key({"flicker_share", "of the periods: short random commands, as a trained BP's"},
        bp.flicker_share, 0.0, 1.0);
  v.key({"flicker_steps", "length of such a period"}, bp.flicker_steps, 1, 100'000);
  v.key({"flicker_hold_max", "longest command in it"}, bp.flicker_hold_max, 1, 100'000);
}

}  // namespace corridor::config_keys
