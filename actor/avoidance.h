// SPDX-License-Identifier: Apache-2.0
// Hindsight: could a recorded collision have been avoided, by the last actions before it, or by any
// reaction to what could be seen?
//
// The episode is driven again as recorded up to k steps before the collision. From there sequences
// of the MoP's actions are tried, depth first, each in a copy of the process (actor/what_if.h) so
// that the simulation is exact, until one leads past the step of the collision and is free of any
// collision still kMarginSteps later. The search is over every sequence, but for actions that lead
// to equal targets; the BP's commands move nothing, and corridors closed by one may be entered.
//
// What the verdicts mean. The search sees how the others react to what it tries, which no driver
// can: kAvoidable is optimistic, and what is kUnavoidable bounds from below the collisions that any
// driver with these actions would have had from there. Where the world drove, a planner takes over
// k steps before.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "actor/driving/collision.h"
#include "actor/driving/scene.h"
#include "actor/world/world.h"
#include "proto/run/actor_task.h"
#include "proto/run/hindsight_record.h"
#include "proto/run/recorded_episode.h"
#include "proto/run/run_directory.h"
#include "proto/settings/settings.h"

namespace corridor::actor {

inline constexpr int kMarginSteps = 4;
// A lateral speed that can be seen: a tenth of SUMO's drivers' own.
inline constexpr double kVisible_mps = 0.1;

// The MoP's actions that lead to different targets, likely escapes first: away from the vehicle
// that hits, then straight on, then towards it; for each the hardest braking first, or the greatest
// acceleration where it comes from behind.
std::vector<std::uint8_t> evasive_actions(const driving::Scene& scene,
                                          const driving::Collision& collision,
                                          const DrivingSettings& settings);

// How many actions were chosen with the cause of the collision in sight: the length of the unbroken
// run of observations, up to the last one before the collision, in which the vehicle that is hit
// or hits moves towards the ego at more than kVisible_mps across the road, or is in its path (they
// overlap across the road); where the ego itself moved sideways into it, is there at all. `seen`
// are the observations from the episode's start to the last one before the collision.
int actions_in_sight(std::span<const driving::Scene> seen, const driving::Collision& collision,
                     const EgoSettings& ego);

// By the last so many actions (at least 1), of which `searched` has the verdicts by the last 1, 2,
// ... up to the first that is avoidable, to the limit, or to the episode's start; at least one.
// What fewer could avoid, more could.
Verdict by_last(int actions, std::span<const Verdict> searched);
// By the actions chosen with the cause in sight: with none, kUnavoidable; with more than were
// searched, kUndecided unless those that were searched could.
Verdict by_reacting(int actions_in_sight, std::span<const Verdict> searched);

// Throws Failure when the episode has no collision or does not drive again as recorded. Equal
// arguments give equal results. When stop_requested(), they are incomplete.
CollisionHindsight look_back(const RunConfig& config, const RecordedEpisode& recorded,
                             world::World& world, const HindsightLimits& limits);

// Looks back on every collision of an evaluation: reads what it (actor/evaluation.h) wrote about
// the task's planner and seed, and writes a record of its collisions. `progress` hears of the
// collisions done, of how many, after each; when it returns false nothing is written. Equal tasks
// write equal files. Throws Failure as look_back does, and when there is no such evaluation.
void report_hindsight(const RunConfig& config, const LookBackTask& task,
                      const RunDirectory& directory, world::World& world,
                      const std::function<bool(std::int64_t done, std::int64_t total)>& progress);

}  // namespace corridor::actor
