// SPDX-License-Identifier: Apache-2.0
#include "actor/planners.h"

#include <utility>

#include "actor/driving/fixed_bp.h"
#include "actor/driving/observation.h"
#include "actor/driving/random_bp.h"
#include "actor/driving/rules.h"
#include "actor/driving/shield.h"
#include "actor/driving/skills.h"

namespace corridor::actor {

QBehaviourPlanner::QBehaviourPlanner(const RunConfig& config, const Networks& networks)
    : settings_(driving_settings(config)),
      values_(config.phase(Phase::kBp), config.shape(Phase::kBp), networks[NetworkId::kBp]),
      observation_(static_cast<std::size_t>(config.shape(Phase::kBp).observations)) {}

driving::Command QBehaviourPlanner::decide(const driving::Situation& situation) {
  return static_cast<driving::Command>(policy::argmax(values(situation)));
}

std::span<const float> QBehaviourPlanner::values(const driving::Situation& situation) {
  driving::observe_bp(situation.scene, situation.previous, settings_, observation_);
  return values_.values(observation_);
}

QMotionPlanner::QMotionPlanner(const RunConfig& config, const Networks& networks)
    : settings_(driving_settings(config)),
      observation_(static_cast<std::size_t>(config.shape(NetworkId::kMop).observations)) {
  for (const driving::Skill& skill : driving::kSkills) {
    const NetworkId id = skill.network;
    values_.try_emplace(id, config.phase(id), config.shape(id), networks[id]);
  }
}

int QMotionPlanner::decide(const driving::Situation& situation, const driving::Window& window) {
  return policy::argmax(values(situation, window));
}

std::span<const float> QMotionPlanner::values(const driving::Situation& situation,
                                              const driving::Window& window) {
  driving::observe_mop(situation.scene, situation.gaps, window, settings_, observation_);
  return values_.at(window.network).values(observation_);
}

std::unique_ptr<driving::BehaviourPlanner> make_behaviour_planner(const PlannerPair& pair,
                                                                  const RunConfig& config,
                                                                  const Networks& networks) {
  using driving::Command, driving::FixedBp;
  const DrivingSettings settings = driving_settings(config);
  switch (pair.bp) {
    case BpKind::kLearned:
      return std::make_unique<QBehaviourPlanner>(config, networks);
    case BpKind::kRules:
      return std::make_unique<driving::RuleBasedBp>(settings);
    case BpKind::kAlwaysKeep:
      return std::make_unique<FixedBp>(Command::kKeep, settings);
    case BpKind::kAlwaysLeft:
      return std::make_unique<FixedBp>(Command::kLeft, settings);
    case BpKind::kAlwaysRight:
      return std::make_unique<FixedBp>(Command::kRight, settings);
    case BpKind::kRandom:
      return std::make_unique<driving::RandomBp>(settings);
    case BpKind::kNone:
      break;
  }
  return nullptr;
}

std::unique_ptr<driving::MotionPlanner> make_motion_planner(const PlannerPair& pair,
                                                            const RunConfig& config,
                                                            const Networks& networks) {
  const DrivingSettings settings = driving_settings(config);
  std::unique_ptr<driving::MotionPlanner> planner;
  switch (pair.mop) {
    case MopKind::kLearned:
      planner = std::make_unique<QMotionPlanner>(config, networks);
      break;
    case MopKind::kRules:
      planner = std::make_unique<driving::RuleBasedMop>(settings);
      break;
    case MopKind::kNone:
      break;
  }
  if (!pair.shielded) return planner;
  return std::make_unique<driving::ShieldedMop>(std::move(planner), settings);
}

}  // namespace corridor::actor
