// SPDX-License-Identifier: Apache-2.0
#include "actor/evaluation.h"

#include <utility>
#include <vector>

#include "proto/base/failure.h"
#include "proto/run/recorded_episode.h"
#include "proto/system/files.h"

namespace corridor::actor {

EpisodeRecord record_of(const EpisodeSummary& summary, std::uint64_t index) {
  EpisodeRecord record;
  record.episode = index;
  record.steps = summary.steps;
  record.bp_reward = summary.bp_reward;
  record.mop_reward = summary.mop_reward;
  if (summary.collision) {
    record.collisions = 1;
    record.collision_kind = summary.collision->kind;
  }
  record.lane_changes = summary.lane_changes;
  record.hard_brakes = summary.hard_brakes;
  record.bypasses = summary.bypasses;
  record.distance_m = summary.distance_m;
  record.lane_steps = summary.lane_steps;
  return record;
}

void evaluate(const RunConfig& config, const Networks& networks, const EvaluateTask& task,
              const RunDirectory& directory, world::World& world,
              const std::function<bool(std::int64_t)>& progress) {
  const PlannerPair& pair = planner_pair(task.planner);
  const auto bp = make_behaviour_planner(pair, config, networks);
  const auto mop = make_motion_planner(pair, config, networks);
  if (task.fcd) create_folders(*task.fcd);

  Episode episode(config, world);
  std::vector<EpisodeRecord> per_episode;
  std::int64_t steps = 0;
  for (std::uint64_t index = 0; steps < task.steps; ++index) {
    const EpisodeName name{task.planner, task.seed, index};
    world::EpisodeStart start{.seed = test_episode_seed(task.seed, index)};
    if (task.fcd) start.fcd_output = *task.fcd / (name.text() + ".fcd.xml");
    if (pair.world_drives()) {
      start.driver = world::EgoDriver::kWorld;
      drive_by_world(episode, start, task.steps - steps);
    } else {
      drive(episode, start, *bp, *mop, task.steps - steps);
    }
    episode.end();
    steps += episode.summary().steps;
    per_episode.push_back(record_of(episode.summary(), index));
    write_recorded_episode(directory,
                           {task.planner, task.seed, index, start.seed, pair.world_drives(),
                            episode.actions(), episode.trajectory_hash(), per_episode.back()});
    if (!progress(steps)) return;
  }
  write_evaluation(directory, evaluation_of({task.planner, task.seed}, config.simulation.step_s,
                                            std::move(per_episode)));
}

}  // namespace corridor::actor
