// SPDX-License-Identifier: Apache-2.0
#include "actor/driving/random_bp.h"

#include "proto/base/failure.h"
#include "proto/base/random.h"

namespace corridor::driving {

RandomBp::RandomBp(const DrivingSettings& settings, Skills skills)
    : settings_(settings), skills_(skills), lanes_(settings) {}

void RandomBp::begin_episode(std::uint64_t episode_seed) {
  seed_ = episode_seed;
  draws_ = 0;
  goal_lane_ = -1;
  flickers_ = false;
  command_ = Command::kKeep;
  // Episodes may be short: some are to begin with a lane change, some without.
  period_ends_ = draw(0, settings_.random_bp.hold_steps_min);
  command_ends_ = 0;
}

Command RandomBp::decide(const Situation& situation) {
  const RandomBpSettings& random = settings_.random_bp;
  const Ego& ego = situation.scene.ego;
  const int lane = lanes_.lane_at(ego.d_m);
  if (lane == goal_lane_) {  // arrived: hold it
    goal_lane_ = -1;
    period_ends_ = situation.step + draw(random.hold_steps_min, random.hold_steps_max);
  }
  if (situation.step >= period_ends_) begin_period(situation.step, lane);
  if (goal_lane_ >= 0) return goal_lane_ > lane ? Command::kLeft : Command::kRight;
  if (!flickers_) return Command::kKeep;
  if (situation.step >= command_ends_) {
    command_ = static_cast<Command>(draw(0, static_cast<int>(skills_.size()) - 1));
    command_ends_ = situation.step + draw(1, random.flicker_hold_max);
  }
  return feasible(command_, ego, settings_, skills_);
}

void RandomBp::begin_period(int step, int lane) {
  const RandomBpSettings& random = settings_.random_bp;
  goal_lane_ = -1;
  flickers_ = random_unit(seed_, Purpose::kRandomBp, {draws_++}) < random.flicker_share;
  if (flickers_) {
    period_ends_ = step + random.flicker_steps;
    command_ends_ = step;
    return;
  }
  // What is not reached in the longest time between two changes is given up.
  period_ends_ = step + random.hold_steps_max;
  if (lanes_.lanes() == 1) return;
  const int other = draw(0, lanes_.lanes() - 2);
  goal_lane_ = other < lane ? other : other + 1;
}

int RandomBp::draw(int least, int most) {
  CORRIDOR_CHECK(least <= most, "{} .. {}", least, most);
  return least + static_cast<int>(random_below(static_cast<std::uint64_t>(most - least + 1), seed_,
                                               Purpose::kRandomBp, {draws_++}));
}

}  // namespace corridor::driving
