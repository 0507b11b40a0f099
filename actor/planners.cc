#include "actor/planners.h"

#include <utility>

#include "actor/driving/observation.h"
#include "actor/driving/rules.h"

namespace corridor::actor {

QBehaviourPlanner::QBehaviourPlanner(const RunConfig& config, std::vector<float> parameters)
    : settings_(driving_settings(config)),
      network_(config.network(Phase::kBp), std::move(parameters)),
      observation_(static_cast<std::size_t>(config.shape(Phase::kBp).observations)) {}

driving::Command QBehaviourPlanner::decide(const driving::Situation& situation) {
  driving::observe_bp(situation.scene, situation.previous, settings_, observation_);
  return static_cast<driving::Command>(network_.greedy(observation_));
}

QMotionPlanner::QMotionPlanner(const RunConfig& config, std::vector<float> parameters)
    : settings_(driving_settings(config)),
      network_(config.network(Phase::kMop), std::move(parameters)),
      observation_(static_cast<std::size_t>(config.shape(Phase::kMop).observations)) {}

int QMotionPlanner::decide(const driving::Situation& situation, const driving::Window& window) {
  driving::observe_mop(situation.scene, situation.gaps, window, settings_, observation_);
  return network_.greedy(observation_);
}

std::unique_ptr<driving::BehaviourPlanner> make_behaviour_planner(const PlannerPair& pair,
                                                                  const RunConfig& config,
                                                                  const TrainedNetworks& networks) {
  if (pair.learned_bp) return std::make_unique<QBehaviourPlanner>(config, networks.bp);
  return std::make_unique<driving::RuleBasedBp>(driving_settings(config));
}

std::unique_ptr<driving::MotionPlanner> make_motion_planner(const PlannerPair& pair,
                                                            const RunConfig& config,
                                                            const TrainedNetworks& networks) {
  if (pair.learned_mop) return std::make_unique<QMotionPlanner>(config, networks.mop);
  return std::make_unique<driving::RuleBasedMop>(driving_settings(config));
}

}  // namespace corridor::actor
