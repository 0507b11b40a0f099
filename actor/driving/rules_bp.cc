#include "actor/driving/rules_bp.h"

#include <algorithm>
#include <cstdlib>

#include "actor/driving/following.h"

namespace corridor::driving {
namespace {

// The room that must be left to go on with a lane change, as a share of that to begin one.
constexpr double kGoOnShare = 0.8;

}  // namespace

RuleBasedBp::RuleBasedBp(const DrivingSettings& settings) : settings_(settings), lanes_(settings) {}

void RuleBasedBp::begin_episode(std::uint64_t) { goal_lane_ = -1; }

Command RuleBasedBp::decide(const Situation& situation) {
  const Scene& scene = situation.scene;
  const int lane = lanes_.lane_at(scene.ego.d_m);
  // Arrived, or out of reach, or out of room.
  if (goal_lane_ >= 0 &&
      (std::abs(goal_lane_ - lane) != 1 || !has_room(scene, goal_lane_, kGoOnShare)))
    goal_lane_ = -1;
  // One change is over before another begins.
  const bool settled = lanes_.corridor_at(scene.ego.d_m) == lanes_.middle_of_lane(lane);
  if (goal_lane_ < 0 && settled) goal_lane_ = better_lane(scene, lane);
  if (goal_lane_ < 0) return Command::kKeep;
  return goal_lane_ > lane ? Command::kLeft : Command::kRight;
}

int RuleBasedBp::better_lane(const Scene& scene, int lane) const {
  const RulesSettings& rules = settings_.rules;
  const double slow_mps = settings_.road.speed_limit_mps - rules.slow_leader_mps;
  const double own_mps = lane_promise_mps(scene, lane);
  if (own_mps < slow_mps) {
    for (const int other : {lane + 1, lane - 1}) {
      if (other < 0 || other >= lanes_.lanes()) continue;
      if (lane_promise_mps(scene, other) >= own_mps + rules.gain_mps && has_room(scene, other, 1.0))
        return other;
    }
    return -1;
  }
  const int right = lane - 1;
  const bool right_is_free =
      right >= 0 && lane_promise_mps(scene, right) >= slow_mps &&
      lane_gaps(scene, right, settings_).front_gap_m >= rules.return_right_s * scene.ego.speed_mps;
  return right_is_free && has_room(scene, right, 1.0) ? right : -1;
}

double RuleBasedBp::lane_promise_mps(const Scene& scene, int lane) const {
  return promise_mps(lane_gaps(scene, lane, settings_), scene.ego, settings_);
}

bool RuleBasedBp::has_room(const Scene& scene, int lane, double share) const {
  const RulesSettings& rules = settings_.rules;
  const CorridorGaps gaps = lane_gaps(scene, lane, settings_);
  const double speed_mps = scene.ego.speed_mps;
  const double follower_mps = std::max(0.0, speed_mps - gaps.back_rate_mps);
  const double front_m = rules.front_gap_s * speed_mps + rules.gap_min_m +
                         closing_way_m(gaps.front_rate_mps, kComfortBraking_mps2);
  const double back_m = rules.back_gap_s * follower_mps + rules.gap_min_m +
                        closing_way_m(gaps.back_rate_mps, kComfortBraking_mps2);
  return gaps.front_gap_m >= share * front_m && gaps.back_gap_m >= share * back_m;
}

}  // namespace corridor::driving
