// SPDX-License-Identifier: Apache-2.0
#include "learner/learner_state.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "learner/training.h"
#include "proto/base/failure.h"
#include "proto/base/json.h"
#include "proto/run/checkpoints.h"

namespace corridor::learner {
namespace {

using testing::HasSubstr;

RunConfig small_config() {
  RunConfig config;
  config.dqn[0].hidden = {8};
  config.dqn[1].hidden = {6};
  config.dqn[1].dueling = true;
  return config;
}

// Somewhere in a phase, everything distinct.
LearnerState some_state(const RunConfig& config, Phase phase) {
  LearnerState state = initial_state(config);
  const auto some = [&](Phase which, std::uint64_t seed) {
    return initial_parameters(config.network(which), seed, which, config.phase(which).networks());
  };
  state.next_round = Schedule(config).first_round(phase) + 4;
  state.td = {some(phase, 2), some(phase, 3), some(phase, 4), some(phase, 5), 777};
  Weights older = state.published[0];
  older.version = state.next_round - 1;
  const Weights newest{state.next_round, {some(Phase::kMop, 6), some(Phase::kBp, 6)}};
  state.published = {older, newest};
  state.best = Candidate{state.next_round - 2, 1.0 / 3.0, some(phase, 8)};
  return state;
}

std::string failure_of(const TensorFile& file, const RunConfig& config) {
  try {
    from_tensors(file, config, kLearnerFile);
  } catch (const Failure& failure) {
    return failure.what();
  }
  return "";
}

TEST(Checkpoint, GivesTheStateBack) {
  const RunConfig config = small_config();
  for (const Phase phase : {Phase::kMop, Phase::kBp}) {
    LearnerState state = some_state(config, phase);
    EXPECT_EQ(from_tensors(to_tensors(state, config), config, "file"), state);
    state.best.reset();
    EXPECT_EQ(from_tensors(to_tensors(state, config), config, "file"), state);
  }
  EXPECT_EQ(from_tensors(to_tensors(initial_state(config), config), config, "file"),
            initial_state(config));
}

TEST(Checkpoint, NamesTheNetworksToDriveWith) {
  const RunConfig config = small_config();
  LearnerState state = some_state(config, Phase::kMop);
  TensorFile file = to_tensors(state, config);
  EXPECT_EQ(file.get<float>("mop", "file"), state.best->parameters);
  EXPECT_EQ(file.get<float>("bp", "file"), state.published[1].networks[Phase::kBp]);

  state.best.reset();
  EXPECT_EQ(to_tensors(state, config).get<float>("mop", "file"),
            state.published[1].networks[Phase::kMop]);

  state = some_state(config, Phase::kBp);
  file = to_tensors(state, config);
  EXPECT_EQ(file.get<float>("mop", "file"), state.published[1].networks[Phase::kMop]);
  EXPECT_EQ(file.get<float>("bp", "file"), state.best->parameters);
}

TEST(Checkpoint, DescribesTheNetworksInItsMetadata) {
  const RunConfig config = small_config();
  const TensorFile file = to_tensors(some_state(config, Phase::kBp), config);
  const auto shape = Json::parse(file.metadata.at("bp.shape"));
  EXPECT_EQ(shape["observations"], config.shape(Phase::kBp).observations);
  EXPECT_EQ(shape["hidden"], std::vector<int>{6});
  EXPECT_EQ(shape["actions"], 3);
  EXPECT_EQ(shape["dueling"], true);
  EXPECT_EQ(file.metadata.at("phase"), "BP");
}

TEST(Checkpoint, IsRefusedByAnotherConfiguration) {
  const RunConfig config = small_config();
  const TensorFile file = to_tensors(some_state(config, Phase::kMop), config);
  RunConfig wider = config;
  wider.dqn[0].hidden = {9};
  EXPECT_THAT(failure_of(file, wider), HasSubstr("was config.toml changed?"));
  RunConfig shorter = config;
  shorter.dqn[0].steps = shorter.dqn[1].steps = 1;
  EXPECT_THAT(failure_of(file, shorter), HasSubstr("rounds done of 2"));
}

TEST(Checkpoint, IsRefusedWhenSomethingIsMissing) {
  const RunConfig config = small_config();
  const TensorFile whole = to_tensors(some_state(config, Phase::kBp), config);
  for (const char* name : {"next_round", "td.online", "td.target", "td.mean_gradient", "td.updates",
                           "published.0.version", "published.1.mop", "best.score"}) {
    TensorFile file = whole;
    file.tensors.erase(name);
    EXPECT_THAT(failure_of(file, config), HasSubstr(kLearnerFile)) << name;
  }
  TensorFile file = whole;
  file.tensors.erase("published.1.version");  // then the newest weights are not those of the round
  EXPECT_THAT(failure_of(file, config), HasSubstr("damaged"));
}

}  // namespace
}  // namespace corridor::learner
