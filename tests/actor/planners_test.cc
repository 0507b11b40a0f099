// SPDX-License-Identifier: Apache-2.0
#include "actor/planners.h"

#include <gtest/gtest.h>

#include "actor/driving/skills.h"
#include "tests/actor/driving/scenes.h"

namespace corridor::actor {
namespace {

using driving::Command;

// Networks without hidden layers but one unit that is never on: an action's value is its bias.
RunConfig config_of_biases() {
  RunConfig config;
  for (DqnSettings& dqn : config.dqn) {
    dqn.hidden = {1};
    dqn.dueling = false;
    dqn.risk_weight = 0.0;
  }
  return config;
}

std::vector<float> preferring(const RunConfig& config, NetworkId id, int action) {
  std::vector<float> parameters(config.parameters(id), 0.0f);
  parameters[config.network(id).layers().back().biases + static_cast<std::size_t>(action)] = 1.0f;
  return parameters;
}

driving::Situation a_situation() {
  return driving::situation_of(driving::random_scene(3, driving::kSettings), driving::kSettings);
}

TEST(LearnedPlanners, AskForWhatTheirNetworkValuesMost) {
  const RunConfig config = config_of_biases();
  const driving::Situation situation = a_situation();
  const driving::Window window =
      driving::window_for(Command::kKeep, situation.scene.ego, driving::kSettings);
  for (int action = 0; action < config.shape(NetworkId::kBp).actions; ++action) {
    Networks networks;
    networks[NetworkId::kBp] = preferring(config, NetworkId::kBp, action);
    QBehaviourPlanner bp(config, networks);
    EXPECT_EQ(bp.decide(situation), static_cast<Command>(action));
  }
  for (int action = 0; action < config.shape(NetworkId::kMop).actions; ++action) {
    Networks networks;
    networks[NetworkId::kMop] = preferring(config, NetworkId::kMop, action);
    QMotionPlanner mop(config, networks);
    EXPECT_EQ(mop.decide(situation, window), action);
    EXPECT_EQ(mop.values(situation, window)[static_cast<std::size_t>(action)], 1.0f);
  }
}

TEST(Planners, ThereAreThoseThatThePairNamesAndNoOthers) {
  const RunConfig config = config_of_biases();
  Networks networks;
  for (const NamedNetwork& network : kNetworks) {
    networks[network.id] = preferring(config, network.id, 0);
  }
  for (const PlannerPair& pair : kPlannerPairs) {
    const auto bp = make_behaviour_planner(pair, config, networks);
    const auto mop = make_motion_planner(pair, config, networks);
    EXPECT_EQ(bp == nullptr, pair.bp == BpKind::kNone) << pair.name;
    EXPECT_EQ(mop == nullptr, pair.mop == MopKind::kNone) << pair.name;
    EXPECT_EQ(dynamic_cast<QBehaviourPlanner*>(bp.get()) != nullptr, pair.bp == BpKind::kLearned)
        << pair.name;
    EXPECT_EQ(dynamic_cast<QMotionPlanner*>(mop.get()) != nullptr,
              pair.mop == MopKind::kLearned && !pair.shielded)
        << pair.name;
  }
}

TEST(Planners, ThatAreFixedAskForTheSameWhateverTheySee) {
  const RunConfig config = config_of_biases();
  for (const auto& [name, command] : {std::pair("keep+rules", Command::kKeep),
                                      {"left+rules", Command::kLeft},
                                      {"right+rules", Command::kRight}}) {
    const auto bp = make_behaviour_planner(planner_pair(name), config, {});
    bp->begin_episode(1);
    const driving::Scene alone{driving::ego_in_the_middle(), {}};
    EXPECT_EQ(bp->decide(driving::situation_of(alone, driving::kSettings)), command) << name;
  }
}

}  // namespace
}  // namespace corridor::actor
