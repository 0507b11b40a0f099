// SPDX-License-Identifier: Apache-2.0
// Which collisions of an evaluation could have been avoided:
// evaluation/hindsight/<planner>_<seed>.json. What the verdicts mean is in actor/avoidance.h.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "proto/run/episode_name.h"
#include "proto/run/run_directory.h"
#include "proto/settings/collision_kinds.h"

namespace corridor {

enum class Verdict { kAvoidable, kUnavoidable, kUndecided };
template <>
inline constexpr auto kChoices<Verdict> = std::to_array<Choice<Verdict>>({
    {Verdict::kAvoidable, "avoidable", "some sequence of actions does not collide"},
    {Verdict::kUnavoidable, "unavoidable", "every sequence collides"},
    {Verdict::kUndecided, "undecided", "given up before all were tried"},
});

// How far a search goes back.
struct HindsightLimits {
  static constexpr int kActionsMax = 10;
  int actions = 4;                   // the last so many, at most; 1 to kActionsMax
  std::int64_t attempts_max = 1000;  // for each number of actions; at least 1

  // Throws Failure for other limits.
  void check() const;
  bool operator==(const HindsightLimits&) const = default;
};

struct CollisionHindsight {
  std::uint64_t episode = 0;  // its index in the evaluation
  CollisionKind collision_kind = CollisionKind::kRearEnded;
  int step = 0;              // of the collision: the episode's last
  int actions_in_sight = 0;  // chosen with the cause of the collision in sight
  Verdict by_reacting = Verdict::kUndecided;
  std::vector<Verdict> by_last_actions;  // by the last 1, 2 ... of all that the limits allow
  std::vector<std::int64_t> attempts;    // one a search
  std::vector<int> recorded;  // the MoP's last actions, as many at most; none where the world drove
  std::vector<std::uint8_t> escape;  // the MoP's actions, with a margin; none when none was found

  template <typename Self, typename Field>
  static void fields(Self& self, Field field) {
    field("episode", self.episode);
    field("collision_kind", self.collision_kind);
    field("step", self.step);
    field("actions_in_sight", self.actions_in_sight);
    field("by_reacting", self.by_reacting);
    field("by_last_actions", self.by_last_actions);
    field("attempts", self.attempts);
    field("recorded", self.recorded);
    field("escape", self.escape);
  }
  bool operator==(const CollisionHindsight&) const = default;
};

// One planner pair on one evaluation seed.
struct HindsightRecord {
  std::string planner;
  std::uint64_t seed = 0;
  std::int64_t steps = 0;  // of the evaluation
  HindsightLimits limits;
  std::vector<CollisionHindsight> collisions;

  template <typename Self, typename Field>
  static void fields(Self& self, Field field) {
    field("planner", self.planner);
    field("seed", self.seed);
    field("steps", self.steps);
    field("actions", self.limits.actions);
    field("attempts_max", self.limits.attempts_max);
    field("collisions", self.collisions);
  }
  void check() const;
  bool operator==(const HindsightRecord&) const = default;
};

// Throws Failure when the disk is full.
void write_hindsight(const RunDirectory& directory, const HindsightRecord& record);
// Throws Failure naming the file when a member is missing or wrong.
HindsightRecord read_hindsight(const std::filesystem::path& file);

}  // namespace corridor
