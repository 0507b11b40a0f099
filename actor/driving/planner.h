// SPDX-License-Identifier: Apache-2.0
// The two planners' interfaces, and what they are given to decide on.
#pragma once

#include <cstdint>
#include <vector>

#include "actor/driving/action.h"
#include "actor/driving/corridors.h"
#include "actor/driving/scene.h"
#include "actor/driving/skills.h"

namespace corridor::driving {

// One instant, seen once and handed to both planners.
struct Situation {
  Scene scene;
  std::vector<CorridorGaps> gaps;     // of the whole road
  Command previous = Command::kKeep;  // command of the last step
  int step = 0;                       // of the episode
};

class BehaviourPlanner {
 public:
  virtual ~BehaviourPlanner() = default;
  // Forgets what it remembers of the last episode.
  virtual void begin_episode(std::uint64_t episode_seed) = 0;
  // Decides anew at every step; no command has a lifetime (paper section III-D).
  virtual Command decide(const Situation& situation) = 0;
};

class MotionPlanner {
 public:
  virtual ~MotionPlanner() = default;
  // A MoP action index. Stateless: what it does follows from its arguments alone.
  virtual int decide(const Situation& situation, const Window& window) = 0;
};

}  // namespace corridor::driving
