// SPDX-License-Identifier: Apache-2.0
#include "actor/episode.h"

#include <utility>

#include "actor/driving/bypass.h"
#include "actor/driving/reward.h"
#include "actor/driving/trajectory.h"
#include "proto/base/failure.h"
#include "proto/base/random.h"

namespace corridor::actor {

using driving::Command;

Episode::Episode(const RunConfig& config, world::World& world, driving::Skills skills)
    : settings_(driving_settings(config)),
      lanes_(settings_),
      step_limit_(config.simulation.episode_steps),
      world_(world),
      skills_(skills) {}

void Episode::begin(const world::EpisodeStart& start) {
  situation_ = {};
  summary_ = {};
  summary_.lane_steps.assign(static_cast<std::size_t>(lanes_.lanes()), 0);
  actions_.clear();
  hash_ = {};
  const driving::Scene scene = world_.begin(start);
  reference_ = scene.ego;
  see(scene, scene.ego);
}

void Episode::end() { world_.end(); }

driving::Window Episode::window(Command command) const {
  const auto& ego = situation_.scene.ego;
  return driving::window_for(driving::feasible(command, ego, settings_, skills_), ego, settings_,
                             skills_);
}

StepOutcome Episode::step(Command command, int mop_action) {
  const auto& ego = situation_.scene.ego;
  const driving::Window shown = window(command);
  const int corridor_before = lanes_.corridor_at(ego.d_m);
  const auto target = driving::target_for(driving::mop_action(mop_action), ego, settings_);
  actions_.push_back(driving::pack(command, mop_action, static_cast<int>(skills_.size())));
  situation_.previous = driving::feasible(command, ego, settings_, skills_);

  StepOutcome outcome = advance(world_.step(driving::Trajectory(reference_, target, settings_)));
  const bool seen_as_it_is = situation_.scene.ego == scene_.ego;
  outcome.mop_reward = driving::mop_reward(
      scene_, seen_as_it_is ? situation_.gaps : driving::corridor_gaps(scene_, settings_), shown,
      settings_);
  outcome.entered_closed = target.corridor != corridor_before && !shown.is_open(target.corridor);
  summary_.mop_reward += outcome.mop_reward;
  return outcome;
}

StepOutcome Episode::step_by_world() { return advance(world_.step_by_world()); }

void Episode::take_over() {
  scene_ = world_.take_over();
  situation_.scene = scene_;
  reference_ = scene_.ego;
}

StepOutcome Episode::advance(const world::StepResult& result) {
  const driving::Scene scene_before = std::move(scene_);
  const driving::Ego& before = scene_before.ego;
  const int lane_before = lanes_.lane_at(before.d_m);
  see(result.scene, result.measured);
  reference_ = result.reference;
  ++situation_.step;

  const driving::Ego& after = scene_.ego;
  const int lane = lanes_.lane_at(after.d_m);
  StepOutcome outcome;
  outcome.bp_reward = driving::bp_reward(lane_before, after, settings_);
  outcome.lane_changed = lane != lane_before;

  ++summary_.steps;
  summary_.bp_reward += outcome.bp_reward;
  summary_.collision = result.collision;
  summary_.lane_changes += outcome.lane_changed;
  summary_.hard_brakes += after.acceleration_mps2 < -kHardBrake_mps2;
  summary_.bypasses += driving::bypasses(scene_before, scene_, settings_);
  summary_.distance_m += after.s_m - before.s_m;
  ++summary_.lane_steps[static_cast<std::size_t>(lane)];
  outcome.episode_ended = result.collision.has_value() || situation_.step >= step_limit_;
  return outcome;
}

void Episode::see(driving::Scene scene, const driving::Ego& measured) {
  const auto& ego = scene.ego;
  for (const double value : {ego.s_m, ego.d_m, ego.speed_mps}) hash_.add_value(value);
  for (const auto& other : scene.others) {
    hash_.add_value(other.id);
    for (const double value : {other.s_m, other.d_m, other.speed_mps}) hash_.add_value(value);
  }
  situation_.scene = scene;
  situation_.scene.ego = measured;
  situation_.gaps = driving::corridor_gaps(situation_.scene, settings_);
  scene_ = std::move(scene);
}

void drive(Episode& episode, const world::EpisodeStart& start, driving::BehaviourPlanner& bp,
           driving::MotionPlanner& mop, std::int64_t step_limit) {
  episode.begin(start);
  bp.begin_episode(start.seed);
  for (std::int64_t i = 0; i < step_limit; ++i) {
    const Command command = bp.decide(episode.situation());
    const int action = mop.decide(episode.situation(), episode.window(command));
    if (episode.step(command, action).episode_ended) return;
  }
}

void drive_by_world(Episode& episode, const world::EpisodeStart& start, std::int64_t step_limit) {
  episode.begin(start);
  for (std::int64_t i = 0; i < step_limit; ++i) {
    if (episode.step_by_world().episode_ended) return;
  }
}

std::uint64_t training_episode_seed(std::uint64_t run_seed, Phase phase, int actor,
                                    std::uint64_t episode) {
  return random_bits(
      run_seed, Purpose::kTrainingEpisode,
      {static_cast<std::uint64_t>(phase), static_cast<std::uint64_t>(actor), episode});
}

std::uint64_t selection_episode_seed(std::uint64_t run_seed, Phase phase, std::uint64_t episode) {
  return random_bits(run_seed, Purpose::kSelectionEpisode,
                     {static_cast<std::uint64_t>(phase), episode});
}

std::uint64_t test_episode_seed(std::uint64_t evaluation_seed, std::uint64_t episode) {
  return random_bits(evaluation_seed, Purpose::kTestEpisode, {episode});
}

}  // namespace corridor::actor
