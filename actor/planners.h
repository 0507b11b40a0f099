// Which planners can drive: the learned ones as planners, and the pairs of the paper's Table I.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "actor/driving/planner.h"
#include "actor/policy/q_network.h"
#include "proto/settings.h"

namespace corridor::actor {

// Greedy on a Q-network.
class QBehaviourPlanner : public driving::BehaviourPlanner {
 public:
  QBehaviourPlanner(const RunConfig& config, std::vector<float> parameters);
  void begin_episode(std::uint64_t) override {}
  driving::Command decide(const driving::Situation& situation) override;

 private:
  DrivingSettings settings_;
  policy::QNetwork network_;
  std::vector<float> observation_;
};

class QMotionPlanner : public driving::MotionPlanner {
 public:
  QMotionPlanner(const RunConfig& config, std::vector<float> parameters);
  int decide(const driving::Situation& situation, const driving::Window& window) override;

 private:
  DrivingSettings settings_;
  policy::QNetwork network_;
  std::vector<float> observation_;
};

// A row of the table.
struct PlannerPair {
  const char* name;
  bool learned_bp;
  bool learned_mop;
  bool world_drives;  // SUMO's own driver model; the other two do not matter
};
inline constexpr PlannerPair kPlannerPairs[] = {
    {"hierarchical", true, true, false}, {"rules", false, false, false},
    {"rules+mop", false, true, false},   {"bp+rules", true, false, false},
    {"sumo", false, false, true},
};

// Throws Failure naming the ones that exist.
const PlannerPair& planner_pair(const std::string& name);

// The trained networks' parameters, in NetworkShape's order.
struct TrainedNetworks {
  std::vector<float> mop;
  std::vector<float> bp;
};

std::unique_ptr<driving::BehaviourPlanner> make_behaviour_planner(const PlannerPair& pair,
                                                                  const RunConfig& config,
                                                                  const TrainedNetworks& networks);
std::unique_ptr<driving::MotionPlanner> make_motion_planner(const PlannerPair& pair,
                                                            const RunConfig& config,
                                                            const TrainedNetworks& networks);

}  // namespace corridor::actor
