// SPDX-License-Identifier: Apache-2.0
// A run that a replay server can be taken through in milliseconds.
#pragma once

#include <cmath>
#include <cstdint>

#include "proto/base/random.h"
#include "proto/settings/settings.h"
#include "proto/wire/messages.h"

namespace corridor::replay {

inline constexpr int kActors = 3;
inline constexpr std::uint64_t kMopRounds = 6;
inline constexpr std::uint64_t kRounds = 10;

// Six rounds of the MoP, four of the BP; the replay holds about two and a half rounds.
inline RunConfig small_config() {
  RunConfig config;
  config.run.seed = 5;
  config.run.actors = kActors;
  config.schedule.steps_per_round = 20;
  for (DqnSettings& dqn : config.dqn) {
    dqn.capacity = 150;
    dqn.minimum_size = 70;
    dqn.batch_size = 8;
    dqn.samples_per_insert = 2.0;
  }
  config.dqn[0].steps = 20 * kActors * kMopRounds;
  config.dqn[1].steps = 20 * kActors * (kRounds - kMopRounds);
  return config;
}

// What an actor sends in a round: a function of both, of uneven length.
inline Insert chunk(std::uint64_t round, std::uint32_t index) {
  const RunConfig config = small_config();
  const Phase phase = round < kMopRounds ? Phase::kMop : Phase::kBp;
  const RowLayout layout{config.shape(phase).observations};
  Insert result;
  result.round = round;
  result.observations = static_cast<std::uint32_t>(layout.observations);
  const std::uint64_t count = 16 + random_below(9, 1, Purpose::kBootstrap, {round, index});
  for (std::uint64_t i = 0; i < count * layout.stride(); ++i) {
    result.rows.push_back(
        static_cast<float>(random_unit(2, Purpose::kBootstrap, {round, index, i})));
  }
  for (std::uint64_t i = 0; i < count; ++i) {
    const double unit = random_unit(3, Purpose::kBootstrap, {round, index, i});
    result.priorities.push_back(static_cast<float>(std::pow(10.0, -6.0 + 9.0 * unit)));
  }
  result.open = {round / 2, {static_cast<std::uint8_t>(index), static_cast<std::uint8_t>(round)}};
  return result;
}

}  // namespace corridor::replay
