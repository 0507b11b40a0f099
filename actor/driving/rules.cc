// SPDX-License-Identifier: Apache-2.0
#include "actor/driving/rules.h"

#include <algorithm>
#include <cstdlib>

#include "actor/driving/prediction.h"
#include "proto/base/failure.h"

namespace corridor::driving {
namespace {

constexpr double kComfortBraking_mps2 = 3.0;  // planned with

// A lane's worth is the speed that brings the ego up to its leader in this time.
constexpr double kHorizon_s = 12.0;

// The room that must be left to go on with a lane change, as a share of that to begin one.
constexpr double kGoOnShare = 0.8;

constexpr double kHardBraking_mps2 = 4.0;  // expected of a leader, at the worst
constexpr double kStopGap_m = 1.0;         // left over when both have braked hard
constexpr double kLeastShare = 0.5;        // of the distance wanted: brake below it
constexpr double kIncreaseHolds_s = 2.0;   // a rise of the set-point is to last so long
constexpr double kBypassGain_mps = 1.0;    // leave a lane's middle for so much more

// How much is left of a corridor's gaps when whoever is behind brakes comfortably; < 0: too little.
struct Slack {
  double front_m = 0.0;
  double back_m = 0.0;
  double least_m() const { return std::min(front_m, back_m); }
};

Slack slack_of(const CorridorGaps& gaps, const RulesSettings& rules) {
  return {
      gaps.front_gap_m - rules.gap_min_m - closing_way_m(gaps.front_rate_mps, kComfortBraking_mps2),
      gaps.back_gap_m - rules.gap_min_m - closing_way_m(gaps.back_rate_mps, kComfortBraking_mps2)};
}

// Room enough to move there, or at least no less than here: the same leader fills many corridors.
bool acceptable(const Slack& there, const Slack& here) {
  return there.front_m >= std::min(0.0, here.front_m) && there.back_m >= std::min(0.0, here.back_m);
}

}  // namespace

double braking_way_m(double speed_mps, double braking_mps2) {
  return speed_mps * speed_mps / (2 * braking_mps2);
}

double closing_way_m(double rate_mps, double braking_mps2) {
  return braking_way_m(std::max(0.0, -rate_mps), braking_mps2);
}

double headway_m(double speed_mps, const DrivingSettings& settings) {
  return settings.mop_reward.headway_s * speed_mps + settings.mop_reward.standstill_gap_m;
}

double promise_mps(const CorridorGaps& gaps, const Ego& ego, const DrivingSettings& settings) {
  const double limit_mps = settings.road.speed_limit_mps;
  if (gaps.front_gap_m >= std::min(settings.rules.leader_range_m, settings.planner.gap_range_m))
    return limit_mps;
  const double spare_m = std::max(0.0, gaps.front_gap_m - headway_m(ego.speed_mps, settings));
  return std::min(limit_mps, ego.speed_mps + gaps.front_rate_mps + spare_m / kHorizon_s);
}

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

RuleBasedMop::RuleBasedMop(const DrivingSettings& settings)
    : settings_(settings), lanes_(settings) {
  if (settings.planner.speed_changes_mps.front() >= 0.0)
    throw Failure("planner.speed_changes_mps: the rules need one below 0, to brake with");
}

int RuleBasedMop::decide(const Situation& situation, const Window& window) {
  const int change = corridor_change(situation, window);
  return index_of({change, speed_change(situation, change)});
}

int RuleBasedMop::corridor_change(const Situation& situation, const Window& window) const {
  const int corridor = lanes_.corridor_at(situation.scene.ego.d_m);
  const auto gaps_in = [&](int c) -> const CorridorGaps& {
    return situation.gaps[static_cast<std::size_t>(c)];
  };
  const CorridorGaps& gaps = gaps_in(corridor);
  const Slack here = slack_of(gaps, settings_.rules);

  const int off_goal = goal_corridor(situation, window) - corridor;
  const int towards_goal = (off_goal > 0) - (off_goal < 0);
  const int next = std::clamp(corridor + towards_goal, 0, lanes_.corridors() - 1);
  // The way back from a closed corridor may lead through another.
  const bool allowed = window.is_open(next) || !window.is_open(corridor);
  if (next != corridor && allowed && acceptable(slack_of(gaps_in(next), settings_.rules), here))
    return towards_goal;

  const double stopping_m = kStopGap_m + closing_way_m(gaps.front_rate_mps, kHardBraking_mps2);
  if (gaps.front_gap_m >= stopping_m) return 0;
  // Threatened: to whichever open neighbour leaves more.
  int safest = 0;
  double most_m = here.least_m();
  for (const int change : {-1, 1}) {
    if (!window.is_open(corridor + change)) continue;
    const double left_m = slack_of(gaps_in(corridor + change), settings_.rules).least_m();
    if (left_m > most_m) {
      safest = change;
      most_m = left_m;
    }
  }
  return safest;
}

// The middle, or what is open beside it when that promises more: past an object at the lane's edge.
int RuleBasedMop::goal_corridor(const Situation& situation, const Window& window) const {
  const auto promise = [&](int corridor) {
    return promise_mps(situation.gaps[static_cast<std::size_t>(corridor)], situation.scene.ego,
                       settings_);
  };
  const int middle = window.first + window.middle();
  const bool lane_is_kept = middle >= 0 && middle < lanes_.corridors() &&
                            middle == lanes_.middle_of_lane(lanes_.lane_of(middle));
  if (!lane_is_kept) return middle;
  int goal = middle;
  for (const int beside : {middle - 1, middle + 1}) {
    if (!window.is_open(beside)) continue;
    if (promise(beside) > promise(goal) + kBypassGain_mps) goal = beside;
  }
  return goal;
}

int RuleBasedMop::speed_change(const Situation& situation, int corridor_change) const {
  const Ego& ego = situation.scene.ego;
  const int corridor = lanes_.corridor_at(ego.d_m);
  const int last = static_cast<int>(settings_.planner.speed_changes_mps.size()) - 1;
  for (int speed_change = last; speed_change > 0; --speed_change) {
    const MopAction action{corridor_change, speed_change};
    const Target target = target_for(action, ego, settings_);
    if (keeps_distance(situation.gaps[static_cast<std::size_t>(corridor)], ego, target) &&
        keeps_distance(situation.gaps[static_cast<std::size_t>(target.corridor)], ego, target))
      return speed_change;
  }
  return 0;
}

bool RuleBasedMop::keeps_distance(const CorridorGaps& gaps, const Ego& ego,
                                  const Target& target) const {
  if (gaps.front_gap_m >= settings_.planner.gap_range_m) return true;
  const double leader_mps = std::max(0.0, ego.speed_mps + gaps.front_rate_mps);
  if (!survives_hard_braking(gaps.front_gap_m, leader_mps, ego, target)) return false;

  // What the step leads to when the leader goes on as it does.
  const Ego next = after_step(ego, target, settings_);
  const double gap_m = gaps.front_gap_m + leader_mps * settings_.step_s - (next.s_m - ego.s_m);
  const double speed_mps = target.set_point_mps;
  const double closing_mps = std::max(0.0, speed_mps - leader_mps);
  const double wanted_m = headway_m(speed_mps, settings_);
  const double braking_m = braking_way_m(closing_mps, kComfortBraking_mps2);
  if (speed_mps <= ego.set_point_mps) return gap_m >= kLeastShare * wanted_m + braking_m;
  return gap_m >= wanted_m + braking_m + closing_mps * kIncreaseHolds_s;
}

// From now on the leader brakes hard, and from the next step on the ego as hard as its actions can.
bool RuleBasedMop::survives_hard_braking(double gap_m, double leader_mps, Ego ego,
                                         Target target) const {
  const double step_s = settings_.step_s;
  while (true) {
    const Ego next = after_step(ego, target, settings_);
    gap_m += way_m(leader_mps, kHardBraking_mps2, step_s) - (next.s_m - ego.s_m);
    if (gap_m < kStopGap_m) return false;
    if (next.speed_mps == 0.0) return true;
    leader_mps = std::max(0.0, leader_mps - kHardBraking_mps2 * step_s);
    ego = next;
    target = target_for({0, 0}, ego, settings_);
  }
}

}  // namespace corridor::driving
