// SPDX-License-Identifier: Apache-2.0
#include "actor/driving/shield.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "actor/driving/collision.h"
#include "actor/driving/prediction.h"

namespace corridor::driving {
namespace {

constexpr double kSwaying_mps = 0.1;  // sideways, within a lane
constexpr double kFollowerReaction_s = 1.0;
constexpr double kFollowerBraking_mps2 = 3.0;
// A driver who moves over to less than kTooClose_m (SUMO's minGap) behind the next one is stopped
// by SUMO with its emergency braking.
constexpr double kTooClose_m = 2.5;
constexpr double kEmergencyBraking_mps2 = 9.0;

// The middle of the lane that it moves sideways to.
double destination_m(const Vehicle& other, const Lanes& lanes) {
  if (std::abs(other.lateral_speed_mps) < kSwaying_mps) return other.d_m;
  const double lane = other.d_m / lanes.lane_width_m() - 0.5;
  const double next = other.lateral_speed_mps > 0.0 ? std::ceil(lane) : std::floor(lane);
  return lanes.lane_centre_m(std::clamp(static_cast<int>(next), 0, lanes.lanes() - 1));
}

// Whether it moves sideways to where somebody is close ahead of it, or beside it but further on.
bool cuts_in_too_close(const Vehicle& other, double destination_m, const Scene& scene) {
  const double sideways_m = destination_m - other.d_m;
  if (sideways_m == 0.0) return false;
  return std::ranges::any_of(scene.others, [&](const Vehicle& leader) {
    const double gap_m = leader.s_m - leader.length_m - other.s_m;
    const double across_m = leader.d_m - other.d_m;
    return leader.id != other.id && leader.s_m > other.s_m && gap_m < kTooClose_m &&
           across_m * sideways_m > 0.0 &&
           std::abs(across_m) - (leader.width_m + other.width_m) / 2 < std::abs(sideways_m);
  });
}

// How somebody drives on: sideways to a place across the road, and braking to a standstill from
// some time on.
struct Course {
  double destination_m = 0.0;
  double braking_from_s = 0.0;
  double braking_mps2 = 0.0;
};

Vehicle later(Vehicle other, const Course& course, double time_s) {
  other.d_m = std::clamp(other.d_m + other.lateral_speed_mps * time_s,
                         std::min(other.d_m, course.destination_m),
                         std::max(other.d_m, course.destination_m));
  const double before_s = std::min(time_s, course.braking_from_s);
  other.s_m +=
      other.speed_mps * before_s + way_m(other.speed_mps, course.braking_mps2, time_s - before_s);
  return other;
}

// In the best manoeuvre that begins with an action; at most the margin.
struct Clearance {
  double expected_m = 0.0;
  double worst_m = 0.0;
  bool is_safe() const { return std::min(expected_m, worst_m) >= kShieldMargin_m; }
};

// What follows from one scene.
class Outlook {
 public:
  Outlook(const Scene& scene, const DrivingSettings& settings)
      : settings_(settings),
        ego_(scene.ego),
        steps_(static_cast<std::size_t>(std::ceil(kShieldHorizon_s / settings.step_s))),
        repeated_speed_changes_{0, unchanged_speed(settings),
                                static_cast<int>(settings.planner.speed_changes_mps.size()) - 1} {
    const Lanes lanes(settings);
    for (const Vehicle& other : scene.others) {
      const bool ahead = other.s_m - other.length_m >= ego_.s_m;
      const bool behind = other.s_m <= ego_.s_m - settings.ego.length_m;
      if (behind && overlap_across(ego_, other, settings.ego)) continue;
      Course expected{destination_m(other, lanes)};
      if (behind) {
        expected.braking_from_s = kFollowerReaction_s;
        expected.braking_mps2 = kFollowerBraking_mps2;
      } else if (cuts_in_too_close(other, expected.destination_m, scene)) {
        expected.braking_mps2 = kEmergencyBraking_mps2;
      }
      Course worst = expected;
      if (ahead) worst.braking_mps2 = std::max(worst.braking_mps2, kShieldLeaderBraking_mps2);
      for (std::size_t half = 1; half <= 2 * steps_; ++half) {
        const double time_s = static_cast<double>(half) * settings.step_s / 2;
        expected_.push_back(later(other, expected, time_s));
        worst_.push_back(later(other, worst, time_s));
      }
    }
  }

  Clearance clearance(const MopAction& action) const {
    const Ego next = after_step(ego_, action, settings_);
    return {best_m(next, expected_), best_m(next, worst_)};
  }

 private:
  // Where others will be: of each 2 * steps_ places, half a step apart, so that none is driven
  // through from one look to the next.
  using Places = std::vector<Vehicle>;

  double best_m(const Ego& next, const Places& others) const {
    const double next_m = std::min(kShieldMargin_m, nearest_m(ego_, next, 1, others));
    double best_m = -std::numeric_limits<double>::infinity();
    for (const int speed_change : repeated_speed_changes_) {
      for (const int corridor_change : {0, -1, 1}) {
        Ego ego = next;
        double least_m = next_m;
        for (std::size_t step = 2; step <= steps_ && least_m > best_m; ++step) {
          const Ego before = ego;
          ego = after_step(before, MopAction{corridor_change, speed_change}, settings_);
          least_m = std::min(least_m, nearest_m(before, ego, step, others));
        }
        best_m = std::max(best_m, least_m);
        if (best_m == next_m) return best_m;
      }
    }
    return best_m;
  }

  // Half way through the step, and at its end.
  double nearest_m(const Ego& before, const Ego& after, std::size_t step,
                   const Places& others) const {
    Ego between = after;
    between.s_m = std::midpoint(before.s_m, after.s_m);
    between.d_m = std::midpoint(before.d_m, after.d_m);
    double nearest_m = std::numeric_limits<double>::infinity();
    for (std::size_t i = 2 * (step - 1); i < others.size(); i += 2 * steps_) {
      nearest_m = std::min({nearest_m, separation_m(between, others[i], settings_.ego),
                            separation_m(after, others[i + 1], settings_.ego)});
    }
    return nearest_m;
  }

  const DrivingSettings& settings_;
  Ego ego_;
  std::size_t steps_;
  std::array<int, 3> repeated_speed_changes_;
  Places expected_;
  Places worst_;
};

}  // namespace

MopAction shielded(const MopAction& action, const Scene& scene, const DrivingSettings& settings) {
  const Outlook outlook(scene, settings);
  const Clearance planned = outlook.clearance(action);
  if (planned.is_safe()) return action;

  const auto rank = [&](const MopAction& candidate, const Clearance& clearance) {
    return std::tuple(-clearance.expected_m, -clearance.worst_m,
                      std::abs(candidate.corridor_change - action.corridor_change),
                      std::abs(candidate.speed_change - action.speed_change));
  };
  MopAction best = action;
  auto best_rank = rank(action, planned);
  const int speed_changes = static_cast<int>(settings.planner.speed_changes_mps.size());
  for (const int corridor_change : {0, -1, 1}) {
    for (int speed_change = 0; speed_change < speed_changes; ++speed_change) {
      const MopAction candidate{corridor_change, speed_change};
      const auto candidate_rank = rank(candidate, outlook.clearance(candidate));
      if (candidate_rank >= best_rank) continue;
      best = candidate;
      best_rank = candidate_rank;
    }
  }
  return best;
}

ShieldedMop::ShieldedMop(std::unique_ptr<MotionPlanner> planner, const DrivingSettings& settings)
    : planner_(std::move(planner)), settings_(settings) {}

int ShieldedMop::decide(const Situation& situation, const Window& window) {
  const MopAction planned = mop_action(planner_->decide(situation, window));
  return index_of(shielded(planned, situation.scene, settings_));
}

}  // namespace corridor::driving
