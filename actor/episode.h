// SPDX-License-Identifier: Apache-2.0
// One episode: the hierarchy's step (command -> window -> action -> trajectory -> world -> rewards)
// in one place, for training, evaluation and driving again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "actor/driving/planner.h"
#include "actor/driving/skills.h"
#include "actor/world/world.h"
#include "proto/base/hash.h"
#include "proto/settings/settings.h"

namespace corridor::actor {

// What happened in one step.
struct StepOutcome {
  double bp_reward = 0.0;   // as in the paper: no shaping
  double mop_reward = 0.0;  // 0 where the world drives
  bool lane_changed = false;
  bool entered_closed = false;  // the ego went into a corridor that was closed: over for learning
  bool episode_ended = false;   // by a collision or the step limit
};

// What happened in an episode so far. Rewards and counts are totals.
struct EpisodeSummary {
  int steps = 0;
  double bp_reward = 0.0;
  double mop_reward = 0.0;
  std::optional<driving::Collision> collision;
  int lane_changes = 0;
  int hard_brakes = 0;  // steps with a deceleration above kHardBrake_mps2
  int bypasses = 0;     // vehicles and objects passed within the lane (driving/bypass.h)
  double distance_m = 0.0;
  std::vector<std::int64_t> lane_steps;  // steps that ended in each lane
};
inline constexpr double kHardBrake_mps2 = 3.0;

// One thread owns it; `world` outlives it.
class Episode {
 public:
  // `skills`: what can be asked for; outlives it.
  Episode(const RunConfig& config, world::World& world, driving::Skills skills = driving::kSkills);

  void begin(const world::EpisodeStart& start);
  // Leaves the episode, so that the world's files are complete.
  void end();

  // What the planners are to decide on now: as it is, but for errors of measuring the ego.
  const driving::Situation& situation() const { return situation_; }
  const driving::Scene& scene() const { return scene_; }  // as it is
  const driving::Ego& reference() const { return reference_; }

  driving::Skills skills() const { return skills_; }
  // What the MoP is shown for a command; where it is not feasible, for the one in its place.
  driving::Window window(driving::Command command) const;

  StepOutcome step(driving::Command command, int mop_action);
  StepOutcome step_by_world();
  // Planners drive on from where the world has driven.
  void take_over();

  const EpisodeSummary& summary() const { return summary_; }
  // The actions of each step so far (driving/action.h: pack); none for those that the world drove.
  const std::vector<std::uint8_t>& actions() const { return actions_; }
  // Over every vehicle's position and speed at every step so far: equal for equal episodes. In hex.
  std::string trajectory_hash() const { return hash_.hex(); }

 private:
  StepOutcome advance(const world::StepResult& result);
  void see(driving::Scene scene, const driving::Ego& measured);

  DrivingSettings settings_;
  driving::Lanes lanes_;
  int step_limit_;
  world::World& world_;
  driving::Skills skills_;
  driving::Situation situation_;
  driving::Scene scene_;
  driving::Ego reference_;  // where the next trajectory starts
  EpisodeSummary summary_;
  std::vector<std::uint8_t> actions_;
  Hash hash_;
};

// Drives one episode from `start` to its end, at most `step_limit` steps of it, and leaves it open.
void drive(Episode& episode, const world::EpisodeStart& start, driving::BehaviourPlanner& bp,
           driving::MotionPlanner& mop, std::int64_t step_limit);
void drive_by_world(Episode& episode, const world::EpisodeStart& start, std::int64_t step_limit);

// The seeds that episodes start from.
std::uint64_t training_episode_seed(std::uint64_t run_seed, Phase phase, int actor,
                                    std::uint64_t episode);
std::uint64_t selection_episode_seed(std::uint64_t run_seed, Phase phase, std::uint64_t episode);
std::uint64_t test_episode_seed(std::uint64_t evaluation_seed, std::uint64_t episode);

}  // namespace corridor::actor
